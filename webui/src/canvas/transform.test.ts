import { describe, expect, test } from "vitest";
import type { Point } from "../scene";
import { type Affine, apply, canvas_from_field, canvas_from_robot, compose, from_pose, identity, inverse, scale_of } from "./transform";
import { numbers_from } from "../testing";

function random_affine(random: () => number): Affine {
  for (;;) {
    const m = { a: random(), b: random(), c: random(), d: random(), e: random(), f: random() };
    if (Math.abs(m.a * m.d - m.b * m.c) > 0.1) return m;
  }
}
function expect_near(actual: Point, expected: Point): void {
  expect(actual[0]).toBeCloseTo(expected[0], 8);
  expect(actual[1]).toBeCloseTo(expected[1], 8);
}

describe("maps", () => {
  test("there and back is where it was; a composed map does both", () => {
    const random = numbers_from(1, -5, 5);
    for (let i = 0; i < 100; ++i) {
      const [m, n] = [random_affine(random), random_affine(random)];
      const p: Point = [random(), random()];
      expect_near(apply(inverse(m), apply(m, p)), p);
      expect_near(apply(compose(m, n), p), apply(m, apply(n, p)));
      expect_near(apply(compose(m, identity), p), apply(m, p));
    }
  });

  test("a pose keeps lengths, puts the robot's origin at the pose, and forward along theta", () => {
    const random = numbers_from(2, -3, 3);
    for (let i = 0; i < 100; ++i) {
      const pose = { x: random(), y: random(), theta: random() };
      const field_from_robot = from_pose(pose);
      expect(scale_of(field_from_robot)).toBeCloseTo(1, 12);
      expect_near(apply(field_from_robot, [0, 0]), [pose.x, pose.y]);
      expect_near(apply(field_from_robot, [1, 0]), [pose.x + Math.cos(pose.theta), pose.y + Math.sin(pose.theta)]);
    }
  });
});

describe("views", () => {
  const area = { x_min: -0.5, x_max: 6, y_min: -3, y_max: 4 };
  const sizes = [[400, 300], [300, 400], [1, 1], [1000, 10]] as const;

  test("the robot's forward is up and its left is left; the field's +x is right and +y up", () => {
    for (const [width, height] of sizes) {
      const robot = canvas_from_robot(area, { width, height });
      const [x, y] = apply(robot, [0, 0]);
      expect(apply(robot, [1, 0])[0]).toBeCloseTo(x);
      expect(apply(robot, [1, 0])[1]).toBeLessThan(y);
      expect(apply(robot, [0, 1])[0]).toBeLessThan(x);
      const field = canvas_from_field(area, { width, height });
      const [fx, fy] = apply(field, [0, 0]);
      expect(apply(field, [1, 0])[0]).toBeGreaterThan(fx);
      expect(apply(field, [0, 1])[1]).toBeLessThan(fy);
    }
  });

  test("the whole area is on the canvas, in its middle, touching two sides, with one scale for both directions", () => {
    for (const [width, height] of sizes) {
      for (const view of [canvas_from_robot, canvas_from_field]) {
        const m = view(area, { width, height });
        const corners = [area.x_min, area.x_max].flatMap((x) => [area.y_min, area.y_max].map((y) => apply(m, [x, y])));
        const xs = corners.map(([x]) => x);
        const ys = corners.map(([, y]) => y);
        const margins = [Math.min(...xs), width - Math.max(...xs), Math.min(...ys), height - Math.max(...ys)];
        for (const margin of margins) expect(margin).toBeGreaterThan(-1e-9);
        expect(Math.min(...margins)).toBeCloseTo(0, 9);
        expect(margins[0]).toBeCloseTo(margins[1]!, 9);
        expect(margins[2]).toBeCloseTo(margins[3]!, 9);
        expect(Math.hypot(m.a, m.b)).toBeCloseTo(Math.hypot(m.c, m.d), 9);
      }
    }
  });
});
