import { area_around, draw_axes, draw_plan, plan_area } from "../canvas/plan";
import { covariance_ellipse, ellipse_points } from "../canvas/ellipse";
import { free_polygons } from "../canvas/free_space";
import { type Canvas2D, type Palette, Pen } from "../canvas/pen";
import { draw_balls, draw_goals, draw_lines, draw_mirrored, draw_robots, draw_tracks, is_moving, place_of, shown_sigmas, sizes_of, team_color } from "../canvas/things";
import { type Affine, apply, type Area, compose, from_pose, scale_of, type Size } from "../canvas/transform";
import type { FieldPlan } from "../link/api";
import type { TeamOpponent, TeamPicture, TeamRobot, TeamThing } from "../link/monitor_api";
import type { Point, Pose } from "../scene";
import { canvas_from_camera, type FieldCamera } from "./field_camera";
import type { Layers } from "./layers";
import { type Measure, measure_words } from "./measuring";
import { duration_words } from "./moment";
import type { Trails } from "./trails";

/// All that the field window shows.
export interface FieldContent {
  readonly picture: TeamPicture | null;
  readonly plan: FieldPlan | null;
  readonly layers: Layers;
  readonly trails: Trails;
  readonly camera: FieldCamera;
  readonly selected: number | null;
  readonly measure: Measure | null;
}

type Placed = TeamRobot & { scene: { pose: Pose } };

const has_place = (robot: TeamRobot): robot is Placed => robot.scene.pose !== null;

/// Robots are never smaller on the screen, [px of the page], and where nobody tells their size not out of proportion to a small field.
const least_radius_px = 10;
const largest_share_of_field = 0.027;

/// Half axes of the ellipse that holds nine of ten, in standard deviations: of the team's ball, which is one answer and no sighting.
const nine_of_ten = Math.sqrt(-2 * Math.log(0.1));

/// What the team has not seen for so long is hardly drawn, [s]; the server forgets it then.
const team_memory = 2;
const least_opacity = 0.25;

/// So much of a robot is left that was not heard for a while.
const stale_opacity = 0.45;

export function team_area({ picture, plan }: Pick<FieldContent, "picture" | "plan">): Area {
  return plan ? plan_area(plan) : area_around((picture?.robots ?? []).flatMap(({ scene }) => scene.pose ?? []));
}

/// The radius of a robot's disc in pixels of the canvas.
export function disc_radius(plan: FieldPlan | null, canvas: Affine, density: number): number {
  const told = sizes_of(plan).robot_radius;
  const radius = plan?.robots === undefined ? Math.min(told, largest_share_of_field * (plan?.length ?? Infinity)) : told;
  return Math.max(radius * scale_of(canvas), least_radius_px * density);
}

/// The robot whose disc is at a point of the canvas, or just beside it; of several, the nearest.
export function robot_at(content: Pick<FieldContent, "picture" | "plan" | "camera">, at: Point, size: Size, density: number): number | null {
  const canvas = canvas_from_camera(content.camera, team_area(content), size);
  let best: number | null = null;
  let least = disc_radius(content.plan, canvas, density) + 5 * density;
  for (const { id, scene: { pose } } of content.picture?.robots ?? []) {
    if (pose === null) continue;
    const [x, y] = apply(canvas, [pose.x, pose.y]);
    const distance = Math.hypot(x - at[0], y - at[1]);
    if (distance <= least) [best, least] = [id, distance];
  }
  return best;
}

/// The team on the field, from above, +x right: what each robot saw last, from where it says it is.
export function draw_team(context: Canvas2D, size: Size, palette: Palette, density: number, content: FieldContent): void {
  const { picture, plan, layers, trails, selected, measure } = content;
  const canvas = canvas_from_camera(content.camera, team_area(content), size);
  const pen = new Pen(context, size, canvas, palette, density);
  pen.clear();
  if (plan) draw_plan(pen, plan);
  else draw_axes(pen);
  if (picture !== null) {
    // Who is heard lies above who is not, the chosen one above all.
    const height = ({ id, presence }: Placed): number => (id === selected ? 3 : presence === "here" ? 2 : presence === "stale" ? 1 : 0);
    const robots = picture.robots.filter(has_place).sort((a, b) => height(a) - height(b));
    const seen = robots.map((robot) => ({ robot, in_robot: pen.within(compose(canvas, from_pose(robot.scene.pose))) }));
    const details = { labels: false, bounds: false, uncertainty: layers.uncertainty, sizes: sizes_of(plan) };
    if (layers.free_space) for (const { robot, in_robot } of seen) draw_free_space(in_robot, robot, robot.id === selected);
    if (layers.trails) for (const robot of robots) draw_trail(pen, robot, trails, picture.t);
    if (layers.lines) for (const { robot, in_robot } of seen) draw_lines(in_robot, robot.scene);
    if (layers.goals) for (const { robot, in_robot } of seen) draw_goals(in_robot, robot.scene, details);
    if (layers.opponents) for (const { robot, in_robot } of seen) draw_robots(in_robot, robot.scene, details);
    if (layers.balls) {
      for (const { robot, in_robot } of seen) draw_sight(in_robot, robot);
      for (const { robot, in_robot } of seen) draw_balls(in_robot, robot.scene, details);
    }
    if (layers.tracks) for (const { robot, in_robot } of seen) draw_tracks(in_robot, robot.scene, details);
    const radius = disc_radius(plan, canvas, density);
    if (layers.team) for (const opponent of picture.opponents) draw_opponent(pen, opponent, radius, layers.uncertainty);
    // Where it may be as well lies below where others are.
    for (const robot of robots) draw_doubt(pen, robot, layers.uncertainty);
    for (const { robot, in_robot } of seen) draw_member(pen, in_robot, robot, radius, robot.id === selected);
    // The one thing all play for lies above all.
    if (layers.team && picture.team_ball !== undefined) draw_team_ball(pen, picture.team_ball, details.sizes.ball_radius, layers.uncertainty);
  }
  if (measure !== null) draw_measure(pen, measure);
}

function draw_free_space(in_robot: Pen, { scene: { free_space } }: Placed, is_selected: boolean): void {
  if (free_space === null) return;
  for (const polygon of free_polygons(free_space)) {
    in_robot.area(polygon, in_robot.palette.free, is_selected ? 0.8 : 0.35);
    if (is_selected) in_robot.outline(polygon, in_robot.palette.faint, 1);
  }
}

function draw_trail(pen: Pen, { id, team, presence, scene: { pose } }: Placed, trails: Trails, t: number): void {
  const faded = pen.within(pen.transform, 0.55);
  const ways = trails.ways(id, t);
  ways.forEach((way, i) => {
    // The last one leads to the robot, which is further on than its last point.
    const points: Point[] = way.map(([x, y]) => [x, y]);
    if (i === ways.length - 1 && presence === "here") points.push([pose.x, pose.y]);
    faded.line(points, team_color(team, pen.palette), 2);
  });
}

/// Which robot sees which ball.
function draw_sight(in_robot: Pen, { team, scene }: Placed): void {
  const thin = in_robot.within(in_robot.transform, 0.7);
  scene.balls.forEach((ball, i) => {
    const at = place_of(ball);
    if (at !== null) thin.line([[0, 0], at], team_color(team, in_robot.palette), 1, i === 0 ? [] : [3, 4]);
  });
}

function draw_doubt(pen: Pen, { id, team, presence, scene: { pose } }: Placed, uncertainty: boolean): void {
  const faded = pen.within(pen.transform, presence === "here" ? 1 : stale_opacity);
  const color = team_color(team, pen.palette);
  if (uncertainty && presence !== "gone") faded.ellipse(covariance_ellipse([pose.x, pose.y], pose.cov, shown_sigmas, 3), color, 0.15);
  if (pose.mirror) draw_mirrored(faded, pose, color, `or ${id} here`);
}

/// A disc with its number and a nose forward; faded when it was not heard of late, an outline when not for long.
///
/// radius  of the disc, pixels of the canvas
function draw_member(pen: Pen, in_robot: Pen, robot: Placed, radius: number, is_selected: boolean): void {
  const { pose } = robot.scene;
  const at: Point = [pose.x, pose.y];
  const color = team_color(robot.team, pen.palette);
  const opacity = robot.presence === "stale" ? stale_opacity : 1;
  const r = radius / scale_of(pen.transform);
  const nose: Point[] = [[1.75 * r, 0], [0.72 * r, 0.7 * r], [0.72 * r, -0.7 * r]];
  const px = radius / pen.density;
  if (robot.presence === "gone") {
    in_robot.outline(nose, color, 1.5);
    pen.disc(at, r, 0, pen.palette.ground);
    pen.ring(at, r, 0, color, 1.5, [3, 3]);
  } else {
    // An edge of the ground's color tells robots apart that touch.
    const faded = pen.within(pen.transform, opacity);
    faded.ring(at, r, 0, pen.palette.ground, 3);
    in_robot.within(in_robot.transform, opacity).outline(nose, pen.palette.ground, 3);
    in_robot.within(in_robot.transform, opacity).area(nose, color);
    faded.disc(at, r, 0, color);
  }
  if (is_selected) pen.ring(at, 1.15 * r, px + 3, pen.palette.self, 2.5);
  pen.inscribe(String(robot.id), at, robot.presence === "here" ? pen.palette.ground : pen.palette.text, (robot.id < 100 ? 1.2 : 0.9) * px);
  if (robot.presence !== "here") pen.label(`${robot.presence} ${duration_words(robot.age)}`, at, pen.palette.text, [px + 7, 0]);
}

function faded_by_age(pen: Pen, { age }: TeamThing): Pen {
  return pen.within(pen.transform, Math.min(Math.max(1 - age / team_memory, least_opacity), 1));
}

/// An outline as large as a robot's disc, with a cross for its number.
///
/// radius  pixels of the canvas
function draw_opponent(pen: Pen, opponent: TeamOpponent, radius: number, uncertainty: boolean): void {
  const at: Point = [opponent.x, opponent.y];
  const color = team_color(opponent.team, pen.palette);
  const r = radius / scale_of(pen.transform);
  const faded = faded_by_age(pen, opponent);
  if (uncertainty) faded.ellipse(covariance_ellipse(at, opponent.cov, nine_of_ten, 4), color, 0.1);
  faded.disc(at, r, 0, pen.palette.ground);
  faded.ring(at, r, 0, color, 3);
  faded.inscribe("×", at, color, (1.5 * radius) / pen.density);
  if (is_moving(opponent)) faded.arrow(at, [opponent.x + opponent.vx, opponent.y + opponent.vy], color);
}

/// Filled as a seen ball is, but larger and with a rim, and its way of the next second.
function draw_team_ball(pen: Pen, ball: TeamThing, radius: number, uncertainty: boolean): void {
  const at: Point = [ball.x, ball.y];
  const faded = faded_by_age(pen, ball);
  const ellipse = uncertainty ? covariance_ellipse(at, ball.cov, nine_of_ten, 4) : null;
  faded.ellipse(ellipse, pen.palette.ball, 0.3);
  if (is_moving(ball)) faded.arrow(at, [ball.x + ball.vx, ball.y + ball.vy], pen.palette.text);
  faded.ring(at, radius, 8, pen.palette.ground, 6);
  faded.disc(at, radius, 8, pen.palette.ball);
  faded.ring(at, radius, 8, pen.palette.text, 2);
  // Many robots know it better than it is large: their ellipse lies within the ball.
  if (ellipse !== null) faded.outline(ellipse_points(ellipse), pen.palette.text, 1.5);
}

function draw_measure(pen: Pen, measure: Measure): void {
  pen.line([measure.from, measure.to], pen.palette.self, 2);
  pen.line([measure.from, [measure.to[0], measure.from[1]], measure.to], pen.palette.faint, 1, [4, 4]);
  for (const end of [measure.from, measure.to]) pen.ring(end, 0, 4, pen.palette.self, 2);
  pen.label(measure_words(measure), measure.to, pen.palette.text, [12, -14]);
}
