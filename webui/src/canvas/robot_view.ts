import { fixed } from "../format";
import type { Scene } from "../scene";
import { blocked_edges, free_polygons } from "./free_space";
import { type Canvas2D, type Palette, Pen } from "./pen";
import { all_details, draw_balls, draw_goals, draw_lines, draw_robots, draw_self, draw_tracks } from "./things";
import { type Area, canvas_from_robot, scale_of, type Size } from "./transform";

/// What the view shows of the floor: mostly what is ahead, but all around for cameras that see all around.
export function robot_area(scene: Scene | null, reach: number): Area {
  const space = scene?.free_space;
  const all_around = space != null && space.ranges.length * space.angle_increment > 1.2 * Math.PI;
  return { x_min: all_around ? -reach : -0.1 * reach, x_max: 1.03 * reach, y_min: -0.75 * reach, y_max: 0.75 * reach };
}

/// The scene in the robot's frame, from above, forward up.
export function draw_robot_view(context: Canvas2D, size: Size, palette: Palette, density: number, scene: Scene | null, reach: number): void {
  const transform = canvas_from_robot(robot_area(scene, reach), size);
  const pen = new Pen(context, size, transform, palette, density);
  pen.clear();
  const step = reach <= 4 ? 1 : reach <= 12 ? 2 : 5;
  if (scene?.free_space) {
    for (const polygon of free_polygons(scene.free_space)) pen.area(polygon, palette.free);
    for (const edge of blocked_edges(scene.free_space)) pen.line(edge, palette.blocked, 2);
  }
  for (let r = step; r <= 1.5 * reach; r += step) pen.circle([0, 0], r, palette.grid, 1);
  pen.line([[-2 * reach, 0], [2 * reach, 0]], palette.grid, 1);
  for (let r = step; r < reach; r += step) pen.note(`${fixed(r, 0)} m`, [r, 0]);
  if (scene) {
    draw_lines(pen, scene);
    draw_goals(pen, scene, all_details);
    draw_robots(pen, scene, all_details);
    draw_balls(pen, scene, all_details);
    draw_tracks(pen, scene, all_details);
  }
  draw_self(pen, (9 * density) / scale_of(transform));
}
