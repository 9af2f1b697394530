import type { ComponentChildren } from "preact";
import { bearing, degrees, fixed, meters, missing } from "../format";
import { useValue } from "../link/observable";
import type { Session } from "../session";

/// What is asked first, large enough to be read from a step away.
export function Tiles({ session }: { session: Session }) {
  const scene = useValue(session.live.read);
  const timing = useValue(session.live.timing);
  const server = useValue(session.server);
  const ball = scene?.balls[0];
  const pose = scene?.pose;
  const total = timing.find(({ stage }) => stage === "total");
  return (
    <dl class="tiles">
      <Tile title="Ball" show="ball">
        {ball ? (ball.distance === null ? "in the image" : <>{meters(ball.distance)} <small>{bearing(ball.bearing)}</small></>) : <Absent scene={scene !== null} />}
      </Tile>
      <Tile title="Pose" show="pose">
        {pose
          ? <>{fixed(pose.x, 2)}, {fixed(pose.y, 2)} m <small>{degrees(pose.theta, 0)}{pose.mirror ? " or mirrored" : ""}</small></>
          : <Absent scene={scene !== null} />}
      </Tile>
      <Tile title="Rate" show="rate">{server ? <>{fixed(server.rate_hz, 1)} <small>frames/s</small></> : missing}</Tile>
      <Tile title="Time a frame" show="total">{total ? <>{fixed(total.ms, 2)} <small>ms</small></> : missing}</Tile>
    </dl>
  );
}

function Absent({ scene }: { scene: boolean }) {
  return <span class="faint">{scene ? "not seen" : missing}</span>;
}

function Tile({ title, show, children }: { title: string; show: string; children: ComponentChildren }) {
  return (
    <div>
      <dt>{title}</dt>
      <dd data-show={`tile-${show}`}>{children}</dd>
    </div>
  );
}
