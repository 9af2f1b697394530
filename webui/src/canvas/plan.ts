import type { FieldPlan } from "../link/api";
import type { Point } from "../scene";
import type { Pen } from "./pen";
import type { Area } from "./transform";

// The field itself, for every view of it.

/// The field, its goals and walls, with a margin.
export function plan_area(plan: FieldPlan): Area {
  const margin = 0.06 * plan.length + 0.2;
  const walls = plan.walls;
  const x = Math.max(plan.length / 2, ...(walls?.x.map(Math.abs) ?? [])) + margin;
  const y = Math.max(plan.width / 2, ...(walls?.y.map(Math.abs) ?? [])) + margin;
  return { x_min: -x, x_max: x, y_min: -y, y_max: y };
}

/// Without a plan: what lies around the middle, as far as these are away, in steps so that it does not swim.
export function area_around(places: readonly { x: number; y: number }[]): Area {
  const away = Math.max(0, ...places.map((place) => Math.max(Math.abs(place.x), 1.5 * Math.abs(place.y))));
  const x = Math.max(5, 2.5 * Math.ceil((away + 0.5) / 2.5));
  return { x_min: -x, x_max: x, y_min: -x / 1.5, y_max: x / 1.5 };
}

/// arc  center, radius, angles from and to, counter-clockwise
function arc_points([cx, cy, radius, from, to]: readonly [number, number, number, number, number]): Point[] {
  return Array.from({ length: 17 }, (_, i) => {
    const angle = from + ((to - from) * i) / 16;
    return [cx + radius * Math.cos(angle), cy + radius * Math.sin(angle)] as Point;
  });
}

export function draw_plan(pen: Pen, plan: FieldPlan): void {
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
  for (const [x0, y0, x1, y1] of plan.segments ?? []) pen.line([[x0, y0], [x1, y1]], color);
  for (const arc of plan.arcs ?? []) pen.line(arc_points(arc), color);
  if (plan.walls) {
    const { x: [left, right], y: [low, high] } = plan.walls;
    if (left < -x || right > x || low < -y || high > y) pen.outline([[left, low], [right, low], [right, high], [left, high]], color, 3);
  }
  for (const goal of plan.goals ?? []) {
    const side = goal.side === "+x" ? 1 : -1;
    const paint = goal.color === "yellow" || goal.color === "blue" ? pen.palette[goal.color] : color;
    const back = side * (x + goal.depth);
    const corners: Point[] = [[side * x, -goal.width / 2], [back, -goal.width / 2], [back, goal.width / 2], [side * x, goal.width / 2]];
    pen.area(corners, paint, 0.35);
  }
}

export function draw_axes(pen: Pen): void {
  pen.line([[-100, 0], [100, 0]], pen.palette.grid, 1);
  pen.line([[0, -100], [0, 100]], pen.palette.grid, 1);
}
