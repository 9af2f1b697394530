import { expect, test } from "vitest";
import { cells_of, missing_places, tint_of } from "./coverage";

test("empty cells have a color of their own; others are the fuller the more points they have, and never hide the picture", () => {
  const tints = Array.from({ length: 200 }, (_, n) => tint_of(n));
  for (let n = 1; n < tints.length; ++n) {
    expect(tints[n]!.color).not.toBe(tints[0]!.color);
    if (n > 1) expect(tints[n]!.alpha).toBeGreaterThanOrEqual(tints[n - 1]!.alpha);
  }
  expect(tints[2]!.alpha).toBeGreaterThan(tints[1]!.alpha);
  for (const { alpha } of tints) expect(alpha > 0 && alpha <= 0.5).toBe(true);
});

test("cells tile the image row by row", () => {
  const cells = cells_of({ columns: 3, rows: 2, points: [0, 1, 2, 3, 4, 5], share: 5 / 6 });
  expect(cells.reduce((sum, { x0, x1, y0, y1 }) => sum + (x1 - x0) * (y1 - y0), 0)).toBeCloseTo(1);
  expect(cells.map(({ is_empty }) => is_empty)).toEqual([true, false, false, false, false, false]);
  expect([cells[2]!.x1, cells[2]!.y0, cells[3]!.x0, cells[3]!.y0]).toEqual([1, 0, 0, 0.5]);
});

test("what is missing is told by its place, the largest first", () => {
  const points = new Array<number>(12 * 9).fill(1);
  expect(missing_places({ columns: 12, rows: 9, points, share: 1 })).toBe("");
  for (const i of [0, 1, 12, 11]) points[i] = 0;
  expect(missing_places({ columns: 12, rows: 9, points, share: 0 })).toBe("upper left, upper right");
  points.fill(1)[4 * 12 + 6] = 0;
  expect(missing_places({ columns: 12, rows: 9, points, share: 0 })).toBe("middle");
  expect(missing_places({ columns: 0, rows: 0, points: [], share: 0 })).toBe("");
});
