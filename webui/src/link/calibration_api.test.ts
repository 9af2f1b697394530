import { describe, expect, test } from "vitest";
import { idle_calibration, some_view } from "../testing";
import { calibration_of } from "./calibration_api";

const whole = {
  ...idle_calibration,
  now: { frame: 7, target: "dots:7x7:0.04:0.01", points: [[1, 2], [3, 4.5]], verdict: "it moves", is_captured: false },
  views: [some_view("1"), { ...some_view("2"), rms_px: 0.2, rejected: "it is blurred" }],
  result: { model: "division", views: 1, rms_px: 0.2, cross_validated_rms_px: null, worst_sigma_px: 0.5, values: [{ name: "fx", value: 400, sigma: 0.3 }], warnings: ["few views"] },
};

/// The same with one thing of it replaced.
function with_fault(path: string, value: unknown): unknown {
  const copy = structuredClone(whole) as unknown;
  const keys = path.split(".");
  const last = keys.pop()!;
  let at = copy as Record<string, unknown>;
  for (const key of keys) at = at[key] as Record<string, unknown>;
  at[last] = value;
  return copy;
}

describe("an answer of the server", () => {
  test("is read as it is", () => {
    expect(calibration_of(structuredClone(whole))).toEqual(whole);
    expect(calibration_of(idle_calibration)).toEqual(idle_calibration);
  });

  test("that is malformed is refused, with what is wrong", () => {
    for (const [path, value, reason] of [
      ["is_on", 1, /is_on must be true or false/], ["targets", "dots", /targets must be a list/], ["model", "fisheye", /model must be one of division/],
      ["width", -1, /width must be a whole/], ["now.points.1", [1], /now\.points\[1\] must be a pair/], ["now.points.0.1", null, /points\[0\]\[1\] must be a number/],
      ["now.frame", Number.NaN, /now\.frame/], ["views.1.rejected", null, /views\[1\]\.rejected must be a text/], ["views.0.points", {}, /views\[0\]\.points/],
      ["coverage.points", [1, 2], /has 2 numbers.* 12/], ["coverage.columns", 0, /has 12 numbers/], ["result.values.0.sigma", null, /values\[0\]\.sigma/],
      ["result.rms_px", "0.1", /rms_px must be a number/], ["file", null, /file must be an object/], ["file.is_saved", undefined, /is_saved/],
    ] as const) expect(() => calibration_of(with_fault(path, value)), path).toThrow(reason);
    for (const none of [null, [], "on", 5]) expect(() => calibration_of(none)).toThrow(/the answer must be an object/);
  });
});
