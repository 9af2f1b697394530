import { expect, test } from "vitest";
import { bearing, count, degrees, fixed, meters, missing, plus_minus, unit } from "./format";

test("a missing number is a dash everywhere, and zero is a number", () => {
  for (const show of [(x: number | null) => fixed(x, 2), degrees, bearing, meters]) {
    expect(show(null)).toBe(missing);
    expect(show(0)).toContain("0");
  }
  expect(fixed(NaN, 1)).toBe(missing);
  expect(plus_minus(null)).toBe("");
});

test("what rounds to zero has no sign, and no side", () => {
  expect(fixed(-0.001, 2)).toBe("0.00");
  expect(bearing(-0.0001)).toBe("0.0°");
  expect(bearing(0)).toBe("0.0°");
});

test("left is counter-clockwise; mirrored is the other side by as much", () => {
  expect(bearing(0.1)).toBe("5.7°\u00a0left");
  for (const angle of [0.01, 0.5, 3.1]) expect(bearing(-angle)).toBe(bearing(angle).replace("left", "right"));
});

test("a number that is shown reads back as the number, rounded", () => {
  for (const value of [-12.345, 0, 0.005, 7, 123456.789]) {
    expect(Number(fixed(value, 2).replace("−", "-"))).toBeCloseTo(value, 1);
  }
});

test("deviations in cm while that has at most two digits before the point", () => {
  expect(plus_minus(0.0123)).toBe("±\u00a01.2\u00a0cm");
  expect(plus_minus(0.0994)).toBe("±\u00a09.9\u00a0cm");
  expect(plus_minus(0.123)).toBe("±\u00a00.12\u00a0m");
});

test("units and counts", () => {
  expect(["1", "px^2", "m/s/sqrt(s)", "m, rad"].map(unit)).toEqual(["", "px²", "m/s/√s", "m, rad"]);
  expect(count(1234567)).toBe("1\u202f234\u202f567");
  expect(count(123)).toBe("123");
});
