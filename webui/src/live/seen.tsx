import type { ComponentChildren } from "preact";
import { sigma_along } from "../canvas/ellipse";
import { bearing, degrees, fixed, meters, missing, plus_minus } from "../format";
import { type Observable, useValue } from "../link/observable";
import type { Ball, Goal, OnFloor, Pose, Robot, Scene, Track } from "../scene";

/// What is seen, in numbers; always the numbers of one scene, whose frame is named.
export function Seen({ scene: source }: { scene: Observable<Scene | null> }) {
  const scene = useValue(source);
  if (scene === null) return <section class="seen"><h2>Seen</h2><p class="faint">no scene yet</p></section>;
  return (
    <section class="seen" data-show="seen" data-frame={scene.frame}>
      <header>
        <h2>Seen</h2>
        <span class="faint">frame <b data-show="frame">{scene.frame}</b> · {fixed(scene.t, 2)} s{scene.image && ` · ${scene.image}`}</span>
      </header>
      <div class="wide">
        <table>
          <thead>
            <tr><th scope="col">what</th><th scope="col" class="number">distance</th><th scope="col" class="number">bearing</th><th scope="col" class="detail">bounds, detail</th></tr>
          </thead>
          <tbody>
            {scene.balls.length === 0 && <Nothing what="ball" />}
            {scene.balls.map((ball, i) => <BallRow key={`b${i}`} ball={ball} first={i === 0} />)}
            {scene.goals.length === 0 && <Nothing what="goals" />}
            {scene.goals.map((goal) => <GoalRow key={goal.color} goal={goal} />)}
            {scene.robots.length === 0 && <Nothing what="robots" />}
            {scene.robots.map((robot, i) => <RobotRow key={`r${i}`} robot={robot} />)}
          </tbody>
        </table>
      </div>
      <PoseList pose={scene.pose} />
      <Tracks tracks={scene.tracks} />
      <Why why={scene.why} />
    </section>
  );
}

function Nothing({ what }: { what: string }) {
  return <tr class="faint"><th scope="row">{what}</th><td colSpan={3}>none in sight</td></tr>;
}

function Row({ show, swatch, name, distance, angle, children }: {
  show: string; swatch: string; name: string; distance: ComponentChildren; angle: number | null; children?: ComponentChildren;
}) {
  return (
    <tr data-show={show}>
      <th scope="row"><span class={`swatch ${swatch}`} aria-hidden="true" />{name}</th>
      <td class="number" data-show="distance">{distance}</td>
      <td class="number" data-show="bearing">{bearing(angle)}</td>
      <td class="faint detail">{children}</td>
    </tr>
  );
}

/// "1.21 – 1.25 m"; without an upper bound "from 1.21 m".
function bounds(thing: OnFloor): string {
  if (thing.near === null) return "";
  return thing.far === null ? `from ${meters(thing.near)}` : `${fixed(thing.near, 2)}\u2009–\u2009${meters(thing.far)}`;
}

function joined(...parts: (string | false | null)[]): string {
  return parts.filter(Boolean).join(" · ");
}

function BallRow({ ball, first }: { ball: Ball; first: boolean }) {
  const sigma = ball.cov && ball.bearing !== null ? plus_minus(sigma_along(ball.cov, ball.bearing)) : null;
  const in_image = ball.distance === null && `at (${fixed(ball.center[0], 0)}, ${fixed(ball.center[1], 0)}) px, radius ${fixed(ball.radius_px, 1)} px`;
  return (
    <Row show="ball" swatch="ball" name={first ? "ball" : "ball?"} distance={meters(ball.distance)} angle={ball.bearing}>
      {joined(sigma, bounds(ball), in_image, `${fixed(100 * ball.confidence, 0)}\u00a0% sure`)}
    </Row>
  );
}

function GoalRow({ goal }: { goal: Goal }) {
  const posts = goal.posts.map(({ side, x, y }) => `${side} post ${meters(Math.hypot(x, y))}`);
  return (
    <Row show="goal" swatch={goal.color} name={`${goal.color} goal`} angle={goal.bearing}
         distance={goal.x === null || goal.y === null ? missing : meters(Math.hypot(goal.x, goal.y))}>
      {joined(...posts)}
    </Row>
  );
}

function RobotRow({ robot }: { robot: Robot }) {
  return (
    <Row show="robot" swatch={robot.team} name={robot.team === "unknown" ? "robot" : `${robot.team} robot`} distance={meters(robot.distance)}
         angle={robot.bearing}>
      {joined(bounds(robot), robot.width !== null && `${meters(robot.width)}\u00a0wide`)}
    </Row>
  );
}

function PoseList({ pose }: { pose: Pose | null }) {
  return (
    <>
      <h3>Pose</h3>
      {pose === null ? <p class="faint">unknown</p> : (
        <dl class="pairs" data-show="pose">
          <div><dt>x</dt><dd><span data-show="x">{meters(pose.x)}</span> <small>{plus_minus(deviation(pose, 0))}</small></dd></div>
          <div><dt>y</dt><dd><span data-show="y">{meters(pose.y)}</span> <small>{plus_minus(deviation(pose, 1))}</small></dd></div>
          <div><dt>theta</dt><dd><span data-show="theta">{degrees(pose.theta)}</span> <small>± {degrees(deviation(pose, 2))}</small></dd></div>
          <div><dt>by</dt><dd data-show="kind">{pose.kind.replace("_", " ")}{pose.mirror && ", or mirrored"}</dd></div>
          <div><dt>last fix</dt><dd>{pose.age === 0 ? "this frame" : `${fixed(pose.age, 2)} s ago`}</dd></div>
        </dl>
      )}
    </>
  );
}

function deviation(pose: Pose, i: 0 | 1 | 2): number {
  return Math.sqrt(Math.max(pose.cov[4 * i] ?? NaN, 0));
}

function Tracks({ tracks }: { tracks: Track[] }) {
  if (tracks.length === 0) return null;
  return (
    <>
      <h3>Followed</h3>
      <div class="wide">
        <table>
          <thead>
            <tr><th scope="col">what</th><th scope="col" class="number">distance</th><th scope="col" class="number">speed</th><th scope="col">seen</th></tr>
          </thead>
          <tbody>
            {tracks.map((track) => (
              <tr key={track.id} data-show="track">
                <th scope="row">
                  <span class={`swatch ${track.kind === "ball" ? "ball" : track.team}`} aria-hidden="true" />
                  {track.kind} <span class="faint">#{track.id}</span>
                </th>
                <td class="number">{meters(Math.hypot(track.x, track.y))}</td>
                <td class="number">{fixed(Math.hypot(track.vx, track.vy), 2)} m/s</td>
                <td class="faint">{track.age === 0 ? "now" : `${fixed(track.age, 2)} s ago`}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </>
  );
}

function Why({ why }: { why: Record<string, string> }) {
  const reasons = Object.entries(why);
  if (reasons.length === 0) return null;
  return (
    <>
      <h3>Why</h3>
      <dl class="why">
        {reasons.map(([subject, reason]) => <div key={subject}><dt>{subject}</dt><dd data-show={`why-${subject}`}>{reason}</dd></div>)}
      </dl>
    </>
  );
}
