import type { Point } from "../scene";

/// Where a Gaussian's density is that of k standard deviations: half axes, and the angle of the longer one.
export interface Ellipse {
  readonly center: Point;
  readonly major: number;
  readonly minor: number;
  readonly angle: number;
}

/// covariance  row-major, its first `columns` columns; only x and y count
/// returns     nothing when it is no covariance: not finite, or negative by more than rounding
/// source      closed form of the eigenvalues of a symmetric 2x2 matrix
export function covariance_ellipse(center: Point, covariance: readonly number[], k: number, columns = 2): Ellipse | null {
  const xx = covariance[0] ?? NaN;
  const yy = covariance[columns + 1] ?? NaN;
  const xy = ((covariance[1] ?? NaN) + (covariance[columns] ?? NaN)) / 2;
  const mean = (xx + yy) / 2;
  const radius = Math.hypot((xx - yy) / 2, xy);
  if (!Number.isFinite(mean + radius + center[0] + center[1])) return null;
  const least = mean - radius;
  if (least < -1e-9 * Math.max(mean + radius, 0) || mean + radius < 0) return null;
  return {
    center,
    major: k * Math.sqrt(mean + radius),
    minor: k * Math.sqrt(Math.max(least, 0)),
    angle: radius === 0 ? 0 : Math.atan2(2 * xy, xx - yy) / 2,
  };
}

/// So many points of it, counter-clockwise; they go through any transform, where a canvas's own ellipse does not.
export function ellipse_points(ellipse: Ellipse, count = 48): Point[] {
  const cos = Math.cos(ellipse.angle);
  const sin = Math.sin(ellipse.angle);
  return Array.from({ length: count }, (_, i) => {
    const u = ellipse.major * Math.cos((2 * Math.PI * i) / count);
    const v = ellipse.minor * Math.sin((2 * Math.PI * i) / count);
    return [ellipse.center[0] + cos * u - sin * v, ellipse.center[1] + sin * u + cos * v] as Point;
  });
}

/// Standard deviation of a position along a direction, [m].
export function sigma_along(covariance: readonly number[], angle: number, columns = 2): number {
  const cos = Math.cos(angle);
  const sin = Math.sin(angle);
  const xx = covariance[0] ?? NaN;
  const yy = covariance[columns + 1] ?? NaN;
  const xy = ((covariance[1] ?? NaN) + (covariance[columns] ?? NaN)) / 2;
  return Math.sqrt(Math.max(cos * cos * xx + 2 * cos * sin * xy + sin * sin * yy, 0));
}
