import type { FieldPlan } from "../link/api";
import type { Point, Scene } from "../scene";
import { covariance_ellipse } from "./ellipse";
import { type Canvas2D, type Palette, Pen } from "./pen";
import { draw_balls, draw_goals, draw_lines, draw_robots, draw_self, draw_tracks, shown_sigmas } from "./things";
import { type Area, canvas_from_field, compose, from_pose, scale_of, type Size } from "./transform";
import { free_polygons } from "./free_space";

/// The field with a margin; without a plan what lies around the middle, as far as the robot is away, in steps so that it does not swim.
export function field_area(plan: FieldPlan | null | undefined, scene: Scene | null): Area {
  if (plan) {
    const margin = 0.06 * plan.length + 0.2;
    const [x, y] = [plan.length / 2 + margin, plan.width / 2 + margin];
    return { x_min: -x, x_max: x, y_min: -y, y_max: y };
  }
  const away = scene?.pose ? Math.max(Math.abs(scene.pose.x), 1.5 * Math.abs(scene.pose.y)) : 0;
  const x = Math.max(5, 2.5 * Math.ceil((away + 0.5) / 2.5));
  return { x_min: -x, x_max: x, y_min: -x / 1.5, y_max: x / 1.5 };
}

/// The scene on the field, from above, +x right. Things are only placed while the pose is known.
export function draw_field_view(
  context: Canvas2D, size: Size, palette: Palette, density: number, scene: Scene | null, plan: FieldPlan | null | undefined,
): void {
  const canvas = canvas_from_field(field_area(plan, scene), size);
  const pen = new Pen(context, size, canvas, palette, density);
  pen.clear();
  if (plan) draw_plan(pen, plan);
  else draw_axes(pen);

  const pose = scene?.pose;
  if (!scene || !pose) return;
  const in_robot = pen.within(compose(canvas, from_pose(pose)));
  if (scene.free_space) for (const polygon of free_polygons(scene.free_space)) in_robot.area(polygon, palette.free, 0.6);
  draw_lines(in_robot, scene);
  draw_goals(in_robot, scene, false);
  draw_robots(in_robot, scene, false);
  draw_balls(in_robot, scene, false);
  draw_tracks(in_robot, scene);
  pen.ellipse(covariance_ellipse([pose.x, pose.y], pose.cov, shown_sigmas, 3), palette.self, 0.2);
  draw_self(in_robot, (10 * density) / scale_of(canvas));
  if (pose.mirror) {
    // As likely: the same place seen from the other goal.
    pen.ring([-pose.x, -pose.y], 0, 9, palette.self, 1.5, [3, 3]);
    pen.label("or here", [-pose.x, -pose.y], palette.text, [12, 0]);
  }
}

function draw_plan(pen: Pen, plan: FieldPlan): void {
  const [x, y] = [plan.length / 2, plan.width / 2];
  const color = pen.palette.grid;
  pen.outline([[-x, -y], [x, -y], [x, y], [-x, y]], color, 1.5);
  if (plan.halfway_line !== false) pen.line([[0, -y], [0, y]], color);
  if (plan.circle_radius) pen.circle([0, 0], plan.circle_radius, color);
  for (const side of [-1, 1]) {
    for (const area of plan.areas ?? []) {
      const inner = side * (x - area.depth);
      pen.line([[side * x, -area.width / 2], [inner, -area.width / 2], [inner, area.width / 2], [side * x, area.width / 2]], color);
    }
  }
  for (const goal of plan.goals ?? []) {
    const side = goal.side === "+x" ? 1 : -1;
    const paint = goal.color === "yellow" || goal.color === "blue" ? pen.palette[goal.color] : color;
    const back = side * (x + goal.depth);
    const corners: Point[] = [[side * x, -goal.width / 2], [back, -goal.width / 2], [back, goal.width / 2], [side * x, goal.width / 2]];
    pen.area(corners, paint, 0.35);
  }
}

function draw_axes(pen: Pen): void {
  pen.line([[-100, 0], [100, 0]], pen.palette.grid, 1);
  pen.line([[0, -100], [0, 100]], pen.palette.grid, 1);
}
