import type { Point } from "../scene";

/// Maps points of one frame to another: x' = a x + c y + e, y' = b x + d y + f, in the order a canvas takes them.
export interface Affine {
  readonly a: number;
  readonly b: number;
  readonly c: number;
  readonly d: number;
  readonly e: number;
  readonly f: number;
}

export const identity: Affine = { a: 1, b: 0, c: 0, d: 1, e: 0, f: 0 };

export function apply(m: Affine, [x, y]: Point): Point {
  return [m.a * x + m.c * y + m.e, m.b * x + m.d * y + m.f];
}

/// outer * inner: inner is applied first.
export function compose(outer: Affine, inner: Affine): Affine {
  const [e, f] = apply(outer, [inner.e, inner.f]);
  return {
    a: outer.a * inner.a + outer.c * inner.b,
    b: outer.b * inner.a + outer.d * inner.b,
    c: outer.a * inner.c + outer.c * inner.d,
    d: outer.b * inner.c + outer.d * inner.d,
    e,
    f,
  };
}

/// Undefined where the map is singular.
export function inverse(m: Affine): Affine {
  const det = m.a * m.d - m.b * m.c;
  return {
    a: m.d / det,
    b: -m.b / det,
    c: -m.c / det,
    d: m.a / det,
    e: (m.c * m.f - m.d * m.e) / det,
    f: (m.b * m.e - m.a * m.f) / det,
  };
}

/// How many units of the target one unit of the source is; for maps that keep shapes.
export function scale_of(m: Affine): number {
  return Math.sqrt(Math.abs(m.a * m.d - m.b * m.c));
}

/// field_from_robot of a pose.
export function from_pose(pose: { x: number; y: number; theta: number }): Affine {
  const cos = Math.cos(pose.theta);
  const sin = Math.sin(pose.theta);
  return { a: cos, b: sin, c: -sin, d: cos, e: pose.x, f: pose.y };
}

/// An area of the floor, [m].
export interface Area {
  readonly x_min: number;
  readonly x_max: number;
  readonly y_min: number;
  readonly y_max: number;
}
/// A canvas in its own pixels, y down.
export interface Size {
  readonly width: number;
  readonly height: number;
}

/// The robot's floor from above, forward up and left left: the area as large as the canvas allows, in its middle.
export function canvas_from_robot(area: Area, size: Size): Affine {
  const width = area.y_max - area.y_min;
  const height = area.x_max - area.x_min;
  const s = Math.min(size.width / width, size.height / height);
  return {
    a: 0,
    b: -s,
    c: -s,
    d: 0,
    e: size.width / 2 + (s * (area.y_max + area.y_min)) / 2,
    f: size.height / 2 + (s * (area.x_max + area.x_min)) / 2,
  };
}

/// The field from above, +x right and +y up: the area as large as the canvas allows, in its middle.
export function canvas_from_field(area: Area, size: Size): Affine {
  const width = area.x_max - area.x_min;
  const height = area.y_max - area.y_min;
  const s = Math.min(size.width / width, size.height / height);
  return {
    a: s,
    b: 0,
    c: 0,
    d: -s,
    e: size.width / 2 - (s * (area.x_max + area.x_min)) / 2,
    f: size.height / 2 + (s * (area.y_max + area.y_min)) / 2,
  };
}
