import { describe, expect, test } from "vitest";
import type { Point } from "../scene";
import { numbers_from } from "../testing";
import { fit_of, outline_of, rate_between } from "./fit";

describe("points over a frame", () => {
  test("fit their own frame wholly, near ones less, those of another moment not at all", () => {
    expect(fit_of(100, 100, 30)).toBe(1);
    for (let apart = 1; apart < 60; ++apart) {
      expect(fit_of(100, 100 + apart, 30)).toBeLessThanOrEqual(fit_of(100, 99 + apart, 30));
      expect(fit_of(100 + apart, 100, 30)).toBe(fit_of(100, 100 + apart, 30));
    }
    expect(fit_of(100, 104, 30)).toBeGreaterThan(0.5);
    expect(fit_of(100, 112, 30)).toBe(0);
    expect(fit_of(100, 102, 2), "a slow camera's next frame is long after").toBe(0);
  });

  test("the camera's rate counts frames that were passed over", () => {
    expect(rate_between({ frame: 10, t: 1 }, { frame: 16, t: 1.2 })).toBeCloseTo(30);
    expect(rate_between({ frame: 10, t: 1 }, { frame: 10, t: 1 })).toBeNull();
    expect(rate_between({ frame: 10, t: 1 }, { frame: 3, t: 1.2 }), "the source began again").toBeNull();
  });
});

test("an outline holds all points and turns one way", () => {
  const random = numbers_from(3, 0, 100);
  for (let n = 0; n < 50; ++n) {
    const points = Array.from({ length: 40 }, (): Point => [random(), random()]);
    const outline = outline_of(points);
    for (let i = 0; i < outline.length; ++i) {
      const [a, b] = [outline[i]!, outline[(i + 1) % outline.length]!];
      for (const [x, y] of points) expect((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])).toBeGreaterThan(-1e-9);
    }
  }
  expect(outline_of([])).toEqual([]);
  expect(outline_of([[1, 2]])).toEqual([[1, 2]]);
  expect(outline_of([[0, 0], [1, 0], [2, 0], [2, 2], [0, 2], [1, 1]])).toEqual([[0, 0], [2, 0], [2, 2], [0, 2]]);
});
