import { describe, expect, test } from "vitest";
import type { FreeSpace, Point } from "../scene";
import { numbers_from } from "../testing";
import { blocked_edges, free_polygons } from "./free_space";

function random_space(seed: number): FreeSpace {
  const random = numbers_from(seed, 0, 1);
  const count = 1 + Math.floor(40 * random());
  const angle_increment = ((0.2 + 0.8 * random()) * 2 * Math.PI) / count / 2;
  const state = Array.from({ length: count }, () => (["blocked", "free", "unseen"] as const)[Math.floor(3 * random())]!);
  return {
    origin: [random() - 0.5, random() - 0.5], angle_min: 6 * random() - 3, angle_increment, state,
    ranges: state.map((s) => (s === "unseen" ? null : 8 * random())),
  };
}

/// Twice the signed area, counter-clockwise positive. source: the shoelace formula
function double_area(polygon: Point[]): number {
  return polygon.reduce((sum, [x, y], i) => {
    const [u, v] = polygon[(i + 1) % polygon.length]!;
    return sum + x * v - u * y;
  }, 0);
}

describe.each(Array.from({ length: 30 }, (_, seed) => seed))("free space of seed %i", (seed) => {
  const space = random_space(seed);
  const seen = space.ranges.filter((range) => range !== null);

  test("its polygons cover the triangles of the seen sectors, no more and no less", () => {
    const expected = seen.reduce((sum, range) => sum + range ** 2 * Math.sin(space.angle_increment), 0);
    expect(free_polygons(space).reduce((sum, polygon) => sum + double_area(polygon), 0)).toBeCloseTo(expected, 8);
  });

  test("each corner is as far from the origin as its sector reaches, and each seen sector has two", () => {
    const ranges = free_polygons(space).flatMap((polygon) => {
      expect(polygon[0]).toEqual(space.origin);
      return polygon.slice(1).map(([x, y]) => Math.hypot(x - space.origin[0], y - space.origin[1]));
    });
    expect(ranges.length).toBe(2 * seen.length);
    seen.forEach((range, i) => {
      expect(ranges[2 * i]).toBeCloseTo(range, 9);
      expect(ranges[2 * i + 1]).toBeCloseTo(range, 9);
    });
  });

  test("a sector's corners lie half a sector to the right and to the left of its middle", () => {
    const corners = free_polygons(space).flatMap((polygon) => polygon.slice(1));
    space.ranges.flatMap((range, i) => (range === null ? [] : [i])).forEach((sector, n) => {
      for (const side of [0, 1]) {
        const [x, y] = corners[2 * n + side]!;
        const angle = space.angle_min + (sector + side - 0.5) * space.angle_increment;
        expect(Math.sin(Math.atan2(y - space.origin[1], x - space.origin[0]) - angle)).toBeCloseTo(0, 8);
      }
    });
  });

  test("there is a polygon for each row of seen sectors", () => {
    const begins = space.ranges.filter((range, i) => range !== null && (i === 0 || space.ranges[i - 1] === null));
    expect(free_polygons(space).length).toBe(begins.length);
  });

  test("its blocked edges are those of the blocked sectors, centered on them", () => {
    const edges = blocked_edges(space);
    const blocked = space.state.flatMap((state, i) => (state === "blocked" ? [i] : []));
    expect(edges.length).toBe(blocked.length);
    edges.forEach(([p, q], n) => {
      const middle = Math.atan2((p[1] + q[1]) / 2 - space.origin[1], (p[0] + q[0]) / 2 - space.origin[0]);
      expect(Math.sin(middle - space.angle_min - blocked[n]! * space.angle_increment)).toBeCloseTo(0, 8);
    });
  });
});

test("nothing seen, nothing free", () => {
  const space: FreeSpace = { origin: [0, 0], angle_min: 0, angle_increment: 0.1, ranges: [null, null], state: ["unseen", "unseen"] };
  expect(free_polygons(space)).toEqual([]);
  expect(blocked_edges(space)).toEqual([]);
  expect(free_polygons({ ...space, ranges: [], state: [] })).toEqual([]);
});
