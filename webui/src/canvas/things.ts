import { meters } from "../format";
import type { FieldPlan } from "../link/api";
import type { Goal, Moving, OnFloor, Point, Robot, Scene, Team, Track } from "../scene";
import { covariance_ellipse } from "./ellipse";
import type { Palette, Pen } from "./pen";

// What is drawn alike in the robot's frame and on the field; pens bring the frame along.

/// Standard deviations that ellipses of uncertainty show.
export const shown_sigmas = 2;

/// Of things whose own size nobody told, [m].
export interface Sizes {
  readonly ball_radius: number;
  readonly robot_radius: number;
}

/// Where no field file is at hand.
const usual_sizes: Sizes = { ball_radius: 0.105, robot_radius: 0.22 };

/// The middle of what the field allows.
export function sizes_of(plan: FieldPlan | null | undefined): Sizes {
  const ball = plan?.ball?.radius;
  const robot = plan?.robots?.width;
  return {
    ball_radius: ball ? (ball[0] + ball[1]) / 2 : usual_sizes.ball_radius,
    robot_radius: robot ? (robot[0] + robot[1]) / 4 : usual_sizes.robot_radius,
  };
}

/// How much of a thing is drawn beside its place.
export interface Details {
  readonly labels: boolean;
  /// On the distance, along the line of sight.
  readonly bounds: boolean;
  readonly uncertainty: boolean;
  readonly sizes: Sizes;
}
export const all_details: Details = { labels: true, bounds: true, uncertainty: true, sizes: usual_sizes };

export function team_color(team: Team, palette: Palette): string {
  return team === "unknown" ? palette.unknown : palette[team];
}

export function place_of(thing: { x: number | null; y: number | null }): Point | null {
  return thing.x === null || thing.y === null ? null : [thing.x, thing.y];
}

/// Beyond every view, [m].
const far_away = 100;

/// The bounds on the distance, along the line of sight; dashed and without an end where there is no upper bound.
function whisker(pen: Pen, thing: OnFloor, color: string): void {
  if (thing.near === null || thing.bearing === null) return;
  const direction: Point = [Math.cos(thing.bearing), Math.sin(thing.bearing)];
  const at = (distance: number): Point => [distance * direction[0], distance * direction[1]];
  pen.line([at(thing.near), at(thing.far ?? far_away)], color, 1.5, thing.far === null ? [3, 5] : []);
}

export function draw_lines(pen: Pen, scene: { readonly lines: Scene["lines"] }): void {
  for (const line of scene.lines) {
    if (line.kind === "circle") pen.circle(line.center, line.radius, pen.palette.line, 2);
    else if (line.p && line.q) pen.line([line.p, line.q], line.kind === "boundary" ? pen.palette.boundary : pen.palette.line, 2.5);
  }
}

export function draw_goals(pen: Pen, scene: { readonly goals: readonly Omit<Goal, "box">[] }, { labels }: Details): void {
  for (const goal of scene.goals) {
    const color = pen.palette[goal.color];
    const posts = goal.posts.map((post): Point => [post.x, post.y]);
    if (posts.length === 2) pen.line(posts, color, 4);
    for (const post of posts) pen.disc(post, 0.06, 4, color);
    const middle = place_of(goal) ?? posts[0];
    if (labels && middle) pen.label(`${goal.color} goal`, middle, color, [8, -12]);
  }
}

export function draw_robots(pen: Pen, scene: { readonly robots: readonly Omit<Robot, "box">[] }, details: Details): void {
  for (const robot of scene.robots) draw_robot(pen, robot, details);
}

function draw_robot(pen: Pen, robot: Omit<Robot, "box">, { labels, bounds, uncertainty, sizes }: Details): void {
  const foot = place_of(robot);
  const center = robot.center ?? foot;
  if (foot === null || center === null) return;
  const color = team_color(robot.team, pen.palette);
  if (robot.cov && uncertainty) pen.ellipse(covariance_ellipse(foot, robot.cov, shown_sigmas), color, 0.12);
  if (bounds) whisker(pen, robot, color);
  pen.ring(center, robot.width == null ? sizes.robot_radius : robot.width / 2, 5, color, 2);
  if (labels) pen.label(meters(robot.distance), center, color, [12, 0]);
}

export function draw_balls(pen: Pen, scene: { readonly balls: readonly OnFloor[] }, { labels, bounds, uncertainty, sizes }: Details): void {
  // The best one last, so that it lies on top.
  for (let i = scene.balls.length - 1; i >= 0; --i) {
    const ball = scene.balls[i]!;
    const at = place_of(ball);
    if (at === null) continue;
    if (ball.cov && uncertainty) pen.ellipse(covariance_ellipse(at, ball.cov, shown_sigmas), pen.palette.ball, 0.25);
    if (bounds) whisker(pen, ball, pen.palette.ball);
    if (i === 0) pen.disc(at, sizes.ball_radius, 5, pen.palette.ball);
    else pen.ring(at, sizes.ball_radius, 5, pen.palette.ball, 1.5, [3, 3]);
    if (labels && i === 0) pen.label(meters(ball.distance), at, pen.palette.ball, [11, 0]);
  }
}

/// A cross where the object is thought to be, dashed ring while it is not seen, and its way of the next second.
export function draw_tracks(pen: Pen, scene: { readonly tracks: readonly Track[] }, { uncertainty, sizes }: Details): void {
  for (const track of scene.tracks) draw_track(pen, track, uncertainty, sizes);
}

function draw_track(pen: Pen, track: Track, uncertainty: boolean, sizes: Sizes): void {
  const color = track.kind === "ball" ? pen.palette.ball : team_color(track.team, pen.palette);
  const at: Point = [track.x, track.y];
  if (track.age > 0) {
    if (uncertainty) pen.ellipse(covariance_ellipse(at, track.cov, shown_sigmas, 4), color, 0.08);
    pen.ring(at, track.kind === "ball" ? sizes.ball_radius : sizes.robot_radius, 5, color, 1.5, [2, 4]);
  }
  if (is_moving(track)) pen.arrow(at, [track.x + track.vx, track.y + track.vy], color);
}

/// A velocity within its own uncertainty points anywhere; an arrow would claim a direction that nobody knows.
export function is_moving(track: Moving): boolean {
  const variance = (track.cov[10] ?? Infinity) + (track.cov[15] ?? Infinity);
  return Math.hypot(track.vx, track.vy) > shown_sigmas * Math.sqrt(variance);
}

/// The robot itself: an arrowhead at its origin, forward along +x.
export function draw_self(pen: Pen, length: number): void {
  pen.area([[length, 0], [-0.7 * length, 0.62 * length], [-0.35 * length, 0], [-0.7 * length, -0.62 * length]], pen.palette.self);
}

/// Where the robot is as likely: the same place seen from the other goal. The pen's frame is the field's.
export function draw_mirrored(pen: Pen, pose: { x: number; y: number }, color: string, words: string): void {
  pen.ring([-pose.x, -pose.y], 0, 9, color, 1.5, [3, 3]);
  pen.label(words, [-pose.x, -pose.y], pen.palette.text, [12, 0]);
}
