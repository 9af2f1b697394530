import type { FieldPlan } from "../link/api";
import type { Scene } from "../scene";
import { covariance_ellipse } from "./ellipse";
import { type Canvas2D, type Palette, Pen } from "./pen";
import { area_around, draw_axes, draw_plan, plan_area } from "./plan";
import { all_details, draw_balls, draw_goals, draw_lines, draw_mirrored, draw_robots, draw_self, draw_tracks, shown_sigmas, sizes_of } from "./things";
import { type Area, canvas_from_field, compose, from_pose, scale_of, type Size } from "./transform";
import { free_polygons } from "./free_space";

export function field_area(plan: FieldPlan | null | undefined, scene: Scene | null): Area {
  return plan ? plan_area(plan) : area_around(scene?.pose ? [scene.pose] : []);
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
  const details = { ...all_details, labels: false, sizes: sizes_of(plan) };
  draw_lines(in_robot, scene);
  draw_goals(in_robot, scene, details);
  draw_robots(in_robot, scene, details);
  draw_balls(in_robot, scene, details);
  draw_tracks(in_robot, scene, details);
  pen.ellipse(covariance_ellipse([pose.x, pose.y], pose.cov, shown_sigmas, 3), palette.self, 0.2);
  draw_self(in_robot, (10 * density) / scale_of(canvas));
  if (pose.mirror) draw_mirrored(pen, pose, palette.self, "or here");
}
