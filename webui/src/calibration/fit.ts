import type { Point } from "../scene";

/// Points older than this are elsewhere by now. [s]
export const nearly_s = 0.4;

/// How well points of one frame fit the picture of another: 1 for the same, less the farther apart, 0 when they must not be drawn over it.
/// rate_hz  of the camera
export function fit_of(points_frame: number, shown_frame: number, rate_hz: number): number {
  const apart = Math.abs(points_frame - shown_frame);
  return apart === 0 ? 1 : Math.max(0, 1 - apart / (nearly_s * Math.max(rate_hz, 1)));
}

/// The camera's rate from two of its frames, however many lie between; null when they do not tell.
export function rate_between(before: { frame: number; t: number }, after: { frame: number; t: number }): number | null {
  const rate = (after.frame - before.frame) / (after.t - before.t);
  return Number.isFinite(rate) && rate > 0 ? rate : null;
}

/// Where points turn around all others, in order. source: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.
export function outline_of(points: readonly Point[]): Point[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const side = (a: Point, b: Point, c: Point): number => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  const half = (all: readonly Point[]): Point[] => {
    const hull: Point[] = [];
    for (const point of all) {
      while (hull.length >= 2 && side(hull.at(-2)!, hull.at(-1)!, point) <= 0) hull.pop();
      hull.push(point);
    }
    return hull.slice(0, -1);
  };
  return sorted.length < 2 ? sorted : [...half(sorted), ...half(sorted.reverse())];
}
