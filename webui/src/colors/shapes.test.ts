import { describe, expect, test } from "vitest";
import type { Point } from "../scene";
import { numbers_from } from "../testing";
import { distance_to_segment, hits, is_empty, is_inside, pixel_at, rectangle_between, signed_area, simplified, to_quarter, within } from "./shapes";

const size = { width: 64, height: 48 };

function points(seed: number, count: number, low = -10, high = 70): Point[] {
  const random = numbers_from(seed, low, high);
  return Array.from({ length: count }, () => [random(), random()]);
}

describe("rectangles", () => {
  test("hold both corners' pixels, whichever way they are drawn, and stay in the image", () => {
    const drawn = points(1, 200);
    for (let i = 0; i + 1 < drawn.length; ++i) {
      const [a, b] = [drawn[i]!, drawn[i + 1]!];
      const { rectangle: [x0, y0, x1, y1] } = rectangle_between(a, b, size);
      expect(rectangle_between(b, a, size).rectangle).toEqual([x0, y0, x1, y1]);
      expect(0 <= x0 && x0 < x1 && x1 <= 64 && 0 <= y0 && y0 < y1 && y1 <= 48).toBe(true);
      for (const corner of [a, b]) {
        const [c, r] = pixel_at(corner, size);
        expect(x0 <= c && c < x1 && y0 <= r && r < y1).toBe(true);
      }
    }
  });

  test("a click is one pixel", () => {
    expect(rectangle_between([3.2, 4.4], [3.2, 4.4], size).rectangle).toEqual([3, 4, 4, 5]);
    expect(pixel_at([2.5, 2.49], size)).toEqual([3, 2]);
  });
});

describe("hits", () => {
  test("a rectangle is hit on its pixels, to their edges", () => {
    const shape = { rectangle: [3, 4, 6, 5] as const };
    expect([[2.5, 3.5], [5.5, 4.5], [4, 4]].every((point) => hits(shape, point as unknown as Point, 0))).toBe(true);
    expect([[2.4, 4], [5.6, 4], [4, 4.6]].some((point) => hits(shape, point as unknown as Point, 0))).toBe(false);
    expect(hits(shape, [1.6, 4], 1)).toBe(true);
  });

  test("even-odd does not mind where a polygon begins, nor its direction", () => {
    for (let seed = 0; seed < 20; ++seed) {
      const polygon = points(seed, 3 + (seed % 5));
      const turned = [...polygon.slice(1), polygon[0]!];
      for (const point of points(1000 + seed, 50)) {
        expect(is_inside(point, turned)).toBe(is_inside(point, polygon));
        expect(is_inside(point, [...polygon].reverse())).toBe(is_inside(point, polygon));
      }
    }
  });

  test("a stroke is hit up to its radius, and its turns are", () => {
    const shape = { stroke: [[0, 0], [10, 0], [10, 10]] as Point[], radius: 2 };
    for (const [x, y, hit] of [[5, 1.9, true], [5, 2.1, false], [-2, 0, true], [-1.5, -1.5, false], [11.9, 5, true], [10, 12, true]] as const) {
      expect(hits(shape, [x, y], 0), `${x}, ${y}`).toBe(hit);
    }
    expect(hits({ stroke: [[4, 4]], radius: 1 }, [4.5, 4.5], 0)).toBe(true);
    expect(hits({ mask: "a.png", value: 1 }, [4, 4], 100)).toBe(false);
  });

  test("the distance to a segment is the least to any of its points", () => {
    for (let seed = 0; seed < 30; ++seed) {
      const [point, a, b] = points(seed, 3) as [Point, Point, Point];
      let least = Infinity;
      for (let i = 0; i <= 1000; ++i) {
        const s = i / 1000;
        least = Math.min(least, Math.hypot(point[0] - a[0] - s * (b[0] - a[0]), point[1] - a[1] - s * (b[1] - a[1])));
      }
      expect(distance_to_segment(point, a, b)).toBeLessThanOrEqual(least + 1e-9);
      expect(distance_to_segment(point, a, b)).toBeGreaterThan(least - 0.1);
    }
  });
});

test("what holds nothing is no shape", () => {
  expect(is_empty({ polygon: [[0, 0], [5, 5]] })).toBe(true);
  expect(is_empty({ polygon: [[0, 0], [5, 5], [10, 10]] })).toBe(true);
  expect(is_empty({ polygon: [[0, 0], [5, 0], [5, 5]] })).toBe(false);
  expect(signed_area([[0, 0], [5, 0], [5, 5]])).toBe(12.5);
  expect(is_empty({ stroke: [], radius: 3 })).toBe(true);
  expect(is_empty({ stroke: [[1, 1]], radius: 3 })).toBe(false);
});

test("a simplified way keeps its ends and comes near every point of the hand's", () => {
  for (let seed = 0; seed < 20; ++seed) {
    const random = numbers_from(seed, -2, 3);
    let [x, y] = [0, 0];
    const path = Array.from({ length: 200 }, (): Point => [x += random(), y += random()]);
    const kept = simplified(path, 0.5);
    expect([kept[0], kept.at(-1)]).toEqual([path[0], path.at(-1)]);
    for (const point of path) {
      let nearest = Infinity;
      for (let i = 1; i < kept.length; ++i) nearest = Math.min(nearest, distance_to_segment(point, kept[i - 1]!, kept[i]!));
      expect(nearest).toBeLessThanOrEqual(0.5 + 1e-9);
    }
  }
  const straight = Array.from({ length: 50 }, (_, i): Point => [i, 2 * i]);
  expect(simplified(straight, 0.1)).toEqual([straight[0], straight.at(-1)]);
});

test("points are kept in the image, in quarters of a pixel", () => {
  for (const point of points(9, 100, -100, 200)) {
    const [x, y] = within(point, size);
    expect(x >= -0.5 && x <= 63.5 && y >= -0.5 && y <= 47.5).toBe(true);
    for (const value of to_quarter(point)) expect(Number.isInteger(4 * value)).toBe(true);
    expect(Math.fround(to_quarter(point)[0])).toBe(to_quarter(point)[0]);
  }
});
