import { describe, expect, test } from "vitest";
import type { Point } from "../scene";
import { add_corner, begin, type Begun, drag, finish, largest_radius, least_radius, next_radius, without_corner } from "./drawing";

const size = { width: 64, height: 48 };

function clicked(points: Point[]): Begun | null {
  return points.reduce<Begun | null>((begun, at) => add_corner(begun, at, 1, size).begun, null);
}

describe("polygon", () => {
  const corners: Point[] = [[2, 2], [20, 2], [20, 20]];

  test("closes at its first corner, with a second click at its last, or with Enter", () => {
    const begun = clicked(corners)!;
    for (const step of [add_corner(begun, [2.5, 2.5], 1, size), add_corner(begun, [20, 20.5], 1, size), finish(begun, size)]) {
      expect(step).toEqual({ begun: null, shape: { polygon: corners } });
    }
  });

  test("with fewer than three corners nothing is finished, nor lost", () => {
    const begun = clicked(corners.slice(0, 2))!;
    expect(finish(begun, size)).toEqual({ begun, shape: null });
    expect(add_corner(begun, [20, 2], 1, size)).toEqual({ begun, shape: null });
  });

  test("corners are taken back one by one, to nothing", () => {
    let begun = clicked(corners);
    for (const left of [2, 1]) {
      begun = without_corner(begun);
      expect(begun).toEqual({ tool: "polygon", corners: corners.slice(0, left) });
    }
    expect(without_corner(begun)).toBeNull();
    expect(without_corner(null)).toBeNull();
  });

  test("corners stay in the image", () => {
    expect(clicked([[-10, 100]])).toEqual({ tool: "polygon", corners: [[-0.5, 47.5]] });
  });
});

test("a rectangle reaches from where the pointer went down to where it went up", () => {
  const begun = drag(drag(begin("rectangle", [10, 20], 3, size), [0, 0], size), [15.2, 99], size);
  expect(finish(begun, size).shape).toEqual({ rectangle: [10, 20, 16, 48] });
});

test("a brush's way is kept, without points that tell nothing", () => {
  let begun = begin("brush", [5, 5], 4, size);
  for (let x = 5; x <= 30; x += 0.5) begun = drag(begun, [x, 5], size);
  for (let y = 5; y <= 20; ++y) begun = drag(begun, [30, y], size);
  expect(finish(begun, size).shape).toEqual({ stroke: [[5, 5], [30, 5], [30, 20]], radius: 4 });
  expect(finish(begin("brush", [5, 5], 4, size), size).shape).toEqual({ stroke: [[5, 5]], radius: 4 });
});

test("brushes grow and shrink through the same sizes, within bounds", () => {
  const sizes = [least_radius];
  while (sizes.at(-1)! < largest_radius) sizes.push(next_radius(sizes.at(-1)!, 1));
  expect(next_radius(largest_radius, 1)).toBe(largest_radius);
  for (let i = sizes.length - 1; i > 0; --i) expect(next_radius(sizes[i]!, -1)).toBe(sizes[i - 1]);
  expect(next_radius(least_radius, -1)).toBe(least_radius);
});
