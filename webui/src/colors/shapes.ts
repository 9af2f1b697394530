import type { Point } from "../scene";

// Shapes in pixels of the image; a pixel's middle is a whole number, so the image reaches from -0.5 to width - 0.5.

export interface Rectangle {
  /// x0, y0, x1, y1; the last column and row do not belong to it.
  readonly rectangle: readonly [number, number, number, number];
}
export interface Polygon {
  readonly polygon: readonly Point[];
}
export interface Stroke {
  readonly stroke: readonly Point[];
  readonly radius: number;
}
/// Made elsewhere; it can only be taken away here.
export interface Mask {
  readonly mask: string;
  readonly value: number;
}
export type Shape = Rectangle | Polygon | Stroke | Mask;

export interface ImageSize {
  readonly width: number;
  readonly height: number;
}

export function kind_of(shape: Shape): "rectangle" | "polygon" | "stroke" | "mask" {
  return "rectangle" in shape ? "rectangle" : "polygon" in shape ? "polygon" : "stroke" in shape ? "stroke" : "mask";
}

/// Quarters of a pixel are exact in every file and language, so what comes back equals what was sent.
export function to_quarter([x, y]: Point): Point {
  return [Math.round(4 * x) / 4, Math.round(4 * y) / 4];
}

/// The nearest point of the image.
export function within([x, y]: Point, { width, height }: ImageSize): Point {
  return [Math.min(Math.max(x, -0.5), width - 0.5), Math.min(Math.max(y, -0.5), height - 0.5)];
}

/// The pixel that holds a point.
export function pixel_at(point: Point, size: ImageSize): Point {
  const whole = (value: number, count: number): number => Math.min(Math.max(Math.floor(value + 0.5), 0), count - 1);
  return [whole(point[0], size.width), whole(point[1], size.height)];
}

/// All pixels between two, both with it.
export function rectangle_between(a: Point, b: Point, size: ImageSize): Rectangle {
  const [[ax, ay], [bx, by]] = [pixel_at(a, size), pixel_at(b, size)];
  return { rectangle: [Math.min(ax, bx), Math.min(ay, by), Math.max(ax, bx) + 1, Math.max(ay, by) + 1] };
}

export function distance_to_segment([x, y]: Point, [ax, ay]: Point, [bx, by]: Point): number {
  const [dx, dy] = [bx - ax, by - ay];
  const length2 = dx * dx + dy * dy;
  const share = length2 === 0 ? 0 : Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / length2, 0), 1);
  return Math.hypot(x - ax - share * dx, y - ay - share * dy);
}

function distance_to_path(point: Point, path: readonly Point[], closed: boolean): number {
  let nearest = path.length === 0 ? Infinity : distance_to_segment(point, path[0]!, path[0]!);
  for (let i = closed ? 0 : 1; i < path.length; ++i) {
    nearest = Math.min(nearest, distance_to_segment(point, path[i === 0 ? path.length - 1 : i - 1]!, path[i]!));
  }
  return nearest;
}

/// Even-odd.
export function is_inside([x, y]: Point, polygon: readonly Point[]): boolean {
  let inside = false;
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    const [[ax, ay], [bx, by]] = [polygon[i]!, polygon[j]!];
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  }
  return inside;
}

/// Is a point on the shape, or nearer to it than `slack`? Never on a mask, whose pixels are not known here.
export function hits(shape: Shape, point: Point, slack: number): boolean {
  if ("mask" in shape) return false;
  if ("rectangle" in shape) {
    const [x0, y0, x1, y1] = shape.rectangle;
    const [x, y] = point;
    return x >= x0 - 0.5 - slack && x <= x1 - 0.5 + slack && y >= y0 - 0.5 - slack && y <= y1 - 0.5 + slack;
  }
  if ("polygon" in shape) return is_inside(point, shape.polygon) || distance_to_path(point, shape.polygon, true) <= slack;
  return distance_to_path(point, shape.stroke, false) <= shape.radius + slack;
}

/// What a person drew by mistake: nothing lies in it.
export function is_empty(shape: Shape): boolean {
  if ("polygon" in shape) return shape.polygon.length < 3 || Math.abs(signed_area(shape.polygon)) < 0.5;
  if ("rectangle" in shape) return shape.rectangle[2] <= shape.rectangle[0] || shape.rectangle[3] <= shape.rectangle[1];
  return "stroke" in shape && shape.stroke.length === 0;
}

export function signed_area(polygon: readonly Point[]): number {
  let sum = 0;
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    sum += polygon[j]![0] * polygon[i]![1] - polygon[i]![0] * polygon[j]![1];
  }
  return sum / 2;
}

/// A hand's way with only the points that matter: each left-out one is nearer than `tolerance` to what stays.
///
/// source  Douglas and Peucker 1973, "Algorithms for the reduction of the number of points", without recursion
export function simplified(path: readonly Point[], tolerance: number): Point[] {
  if (path.length < 3) return [...path];
  const keep = new Uint8Array(path.length);
  keep[0] = keep[path.length - 1] = 1;
  const open: [number, number][] = [[0, path.length - 1]];
  for (let span = open.pop(); span !== undefined; span = open.pop()) {
    const [begin, end] = span;
    let [furthest, distance] = [-1, tolerance];
    for (let i = begin + 1; i < end; ++i) {
      const d = distance_to_segment(path[i]!, path[begin]!, path[end]!);
      if (d > distance) [furthest, distance] = [i, d];
    }
    if (furthest < 0) continue;
    keep[furthest] = 1;
    open.push([begin, furthest], [furthest, end]);
  }
  return path.filter((_, i) => keep[i] === 1);
}
