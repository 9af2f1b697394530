import { type Affine, apply, type Area, canvas_from_field, inverse, type Size } from "../canvas/transform";
import type { Point } from "../scene";

/// What of the field is seen: a point of it in the middle of the canvas, and how much larger than fitting. Null: all of it.
export type FieldCamera = { readonly center: Point; readonly zoom: number } | null;

const smallest_zoom = 0.5;
const largest_zoom = 40;

export function canvas_from_camera(camera: FieldCamera, area: Area, size: Size): Affine {
  const fitting = canvas_from_field(area, size);
  if (camera === null) return fitting;
  const s = fitting.a * camera.zoom;
  return { a: s, b: 0, c: 0, d: -s, e: size.width / 2 - s * camera.center[0], f: size.height / 2 + s * camera.center[1] };
}

function seen_of(camera: FieldCamera, area: Area): NonNullable<FieldCamera> {
  return camera ?? { center: [(area.x_min + area.x_max) / 2, (area.y_min + area.y_max) / 2], zoom: 1 };
}

/// Some of the area stays in sight.
function kept({ center: [x, y], zoom }: NonNullable<FieldCamera>, area: Area): NonNullable<FieldCamera> {
  return { center: [Math.min(Math.max(x, area.x_min), area.x_max), Math.min(Math.max(y, area.y_min), area.y_max)], zoom };
}

/// The point of the field under `anchor`, a point of the canvas, stays there.
export function zoomed(camera: FieldCamera, factor: number, anchor: Point, area: Area, size: Size): FieldCamera {
  const before = seen_of(camera, area);
  const zoom = Math.min(Math.max(before.zoom * factor, smallest_zoom), largest_zoom);
  const [x, y] = apply(inverse(canvas_from_camera(camera, area, size)), anchor);
  const s = canvas_from_field(area, size).a * zoom;
  return kept({ center: [x + (size.width / 2 - anchor[0]) / s, y - (size.height / 2 - anchor[1]) / s], zoom }, area);
}

/// By so many pixels of the canvas.
export function panned(camera: FieldCamera, by: Point, area: Area, size: Size): FieldCamera {
  const { center, zoom } = seen_of(camera, area);
  const s = canvas_from_field(area, size).a * zoom;
  return kept({ center: [center[0] - by[0] / s, center[1] + by[1] / s], zoom }, area);
}
