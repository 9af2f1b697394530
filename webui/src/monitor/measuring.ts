import { degrees, fixed, meters } from "../format";
import type { Point } from "../scene";

/// From here to there, field frame, [m].
export interface Measure {
  readonly from: Point;
  readonly to: Point;
}

export interface Measured {
  readonly distance: number;
  readonly dx: number;
  readonly dy: number;
  /// Counter-clockwise from the field's x; null where there is no way.
  readonly angle: number | null;
}

export function measured({ from, to }: Measure): Measured {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const distance = Math.hypot(dx, dy);
  return { distance, dx, dy, angle: distance === 0 ? null : Math.atan2(dy, dx) };
}

export function measure_words(measure: Measure): string {
  const { distance, dx, dy, angle } = measured(measure);
  return `${meters(distance)}, dx ${fixed(dx, 2)}, dy ${fixed(dy, 2)}, ${degrees(angle)}`;
}

export function place_words([x, y]: Point): string {
  return `x ${fixed(x, 2)}, y ${fixed(y, 2)} m`;
}
