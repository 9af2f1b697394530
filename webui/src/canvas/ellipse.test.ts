import { expect, test } from "vitest";
import { numbers_from } from "../testing";
import { covariance_ellipse, ellipse_points, sigma_along } from "./ellipse";

/// L L' of a random lower triangle: any covariance can be had so.
function random_covariance(random: () => number): [number, number, number, number] {
  const [a, b, c] = [random(), random(), random()];
  return [a * a, a * b, a * b, b * b + c * c];
}

test("each of its points is k standard deviations from the middle", () => {
  const random = numbers_from(1, -2, 2);
  for (let i = 0; i < 100; ++i) {
    const cov = random_covariance(random);
    const [xx, xy, , yy] = cov;
    const det = xx * yy - xy * xy;
    if (det < 1e-3) continue;
    const k = 0.5 + Math.abs(random());
    const center: [number, number] = [random(), random()];
    for (const [x, y] of ellipse_points(covariance_ellipse(center, cov, k)!)) {
      const [dx, dy] = [x - center[0], y - center[1]];
      expect((yy * dx * dx - 2 * xy * dx * dy + xx * dy * dy) / det).toBeCloseTo(k * k, 6);
    }
  }
});

test("its half axes are the greatest and the least deviation of all directions", () => {
  const random = numbers_from(2, -2, 2);
  for (let i = 0; i < 50; ++i) {
    const cov = random_covariance(random);
    const ellipse = covariance_ellipse([0, 0], cov, 1)!;
    expect(sigma_along(cov, ellipse.angle)).toBeCloseTo(ellipse.major, 7);
    expect(sigma_along(cov, ellipse.angle + Math.PI / 2)).toBeCloseTo(ellipse.minor, 5);
    for (let angle = 0; angle < Math.PI; angle += 0.1) {
      expect(sigma_along(cov, angle)).toBeLessThanOrEqual(ellipse.major + 1e-9);
      expect(sigma_along(cov, angle)).toBeGreaterThanOrEqual(ellipse.minor - 1e-9);
    }
  }
});

test("turns with its covariance, and grows with k", () => {
  const random = numbers_from(3, -2, 2);
  for (let i = 0; i < 50; ++i) {
    const [xx, xy, , yy] = random_covariance(random);
    const turn = random();
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    const off = c * s * (xx - yy) + (c * c - s * s) * xy;
    const turned = [c * c * xx - 2 * c * s * xy + s * s * yy, off, off, s * s * xx + 2 * c * s * xy + c * c * yy];
    const [before, after] = [covariance_ellipse([0, 0], [xx, xy, xy, yy], 1)!, covariance_ellipse([0, 0], turned, 3)!];
    expect(after.major).toBeCloseTo(3 * before.major, 6);
    expect(after.minor).toBeCloseTo(3 * before.minor, 5);
    if (before.major - before.minor > 0.1) expect(Math.sin(after.angle - before.angle - turn)).toBeCloseTo(0, 6);
  }
});

test("takes x and y of larger covariances", () => {
  const pose = [4, 0, 9, 0, 1, 9, 9, 9, 9];
  expect(covariance_ellipse([0, 0], pose, 1, 3)).toEqual(covariance_ellipse([0, 0], [4, 0, 0, 1], 1));
});

test("certain is a point, certain along one direction a line; what is no covariance is nothing", () => {
  expect(covariance_ellipse([1, 2], [0, 0, 0, 0], 2)).toEqual({ center: [1, 2], major: 0, minor: 0, angle: 0 });
  const line = covariance_ellipse([0, 0], [1, 1, 1, 1], 1)!;
  expect(line.minor).toBeCloseTo(0, 6);
  expect(line.angle).toBeCloseTo(Math.PI / 4);
  expect(covariance_ellipse([0, 0], [1, 2, 2, 1], 1)).toBeNull();
  expect(covariance_ellipse([0, 0], [-1, 0, 0, 1], 1)).toBeNull();
  expect(covariance_ellipse([0, 0], [NaN, 0, 0, 1], 1)).toBeNull();
  expect(covariance_ellipse([0, 0], [], 1)).toBeNull();
});
