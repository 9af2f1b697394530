import type { Coverage } from "../link/calibration_api";

/// How the map tints a cell of the image.
export interface Tint {
  readonly color: string;
  readonly alpha: number;
}

/// Seen on gray pictures, and told apart by those who do not tell red from green.
export const missing_color = "#ff8a1f", covered_color = "#19b6a0";
const least_alpha = 0.14, most_alpha = 0.5;
/// With so many points a cell is as full as it can be shown.
const full_points = 40;

/// Empty cells are missing; others are the fuller the more points they have, the first ones counting most.
export function tint_of(points: number): Tint {
  if (points <= 0) return { color: missing_color, alpha: 0.17 };
  const share = Math.min(Math.log1p(points) / Math.log1p(full_points), 1);
  return { color: covered_color, alpha: least_alpha + (most_alpha - least_alpha) * share };
}

export interface Cell extends Tint {
  readonly x0: number;
  readonly y0: number;
  readonly x1: number;
  readonly y1: number;
  readonly is_empty: boolean;
}

/// In shares of the image.
export function cells_of({ columns, rows, points }: Coverage): Cell[] {
  return points.map((n, i) => {
    const [column, row] = [i % columns, Math.floor(i / columns)];
    return { x0: column / columns, x1: (column + 1) / columns, y0: row / rows, y1: (row + 1) / rows, is_empty: n <= 0, ...tint_of(n) };
  });
}

/// Where a target has never been, in words for those who do not see the map; empty when it has been everywhere.
export function missing_places({ columns, rows, points }: Coverage): string {
  const [across, down] = [["left", "middle", "right"], ["upper", "middle", "lower"]] as const;
  const empty = new Map<string, number>();
  points.forEach((n, i) => {
    if (n > 0) return;
    const third = (at: number, of: number): number => Math.min(Math.floor((3 * (at + 0.5)) / of), 2);
    const [x, y] = [across[third(i % columns, columns)]!, down[third(Math.floor(i / columns), rows)]!];
    const place = x === y ? "middle" : y === "middle" ? x : x === "middle" ? `${y} middle` : `${y} ${x}`;
    empty.set(place, (empty.get(place) ?? 0) + 1);
  });
  return [...empty].sort((a, b) => b[1] - a[1]).slice(0, 3).map(([place]) => place).join(", ");
}
