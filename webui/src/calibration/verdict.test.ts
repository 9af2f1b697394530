import { expect, test } from "vitest";
import type { Calibration } from "../link/calibration_api";
import { idle_calibration, some_view } from "../testing";
import type { CalibrationView } from "./calibration_model";
import { verdict_of, why_not_kept, why_not_solved, with_sigma } from "./verdict";

const view = (part: Partial<Calibration> | null, rest: Partial<CalibrationView> = {}): CalibrationView =>
  ({ calibration: part === null ? null : { ...idle_calibration, ...part }, pending: [], wanted: {}, refusal: "", trouble: "", captured: null, results: 0, ...rest });
const now = (target: string | null, verdict: string, is_captured = false) => ({ frame: 1, target, points: [], verdict, is_captured });

test("the verdict is the frame's, unless something else is to be known first", () => {
  const on = { is_on: true, now: now("dots:7x7:0.04:0.01", "it moves") };
  expect(verdict_of(view(on))).toEqual({ text: "it moves", detail: "", tone: "wait" });
  expect(verdict_of(view({ ...on, now: now(null, "no target found: no dots:7x7:0.04:0.01: no frame") })))
    .toEqual({ text: "no target found", detail: "no dots:7x7:0.04:0.01: no frame", tone: "none" });
  expect(verdict_of(view({ ...on, now: now("dots:7x7:0.04:0.01", "captured", true) })).tone).toBe("good");
  expect(verdict_of(view(on, { captured: "4" }))).toEqual({ text: "view 4 captured", detail: "", tone: "good" });
  for (const idle of [view(null), view({}), view({ is_on: true }), view({ ...on, is_solving: true }), view(on, { trouble: "away" })]) expect(verdict_of(idle).tone).toBe("idle");
});

test("what cannot be done says why", () => {
  const result = { model: "division", views: 3, rms_px: 0.1, cross_validated_rms_px: null, worst_sigma_px: null, values: [], warnings: [] };
  expect(why_not_solved(view({ views: [some_view("1")] }))).toBe("");
  expect(why_not_solved(view({}))).toMatch(/no views/);
  expect(why_not_solved(view({ views: [some_view("1")], is_solving: true }))).not.toBe("");
  expect(why_not_kept(view({ result }))).toBe("");
  expect(why_not_kept(view({}))).toMatch(/no result/);
  expect(why_not_kept(view({ result, file: { camera: "c", refusal: "the folder cannot be written", is_saved: false } }))).toBe("the folder cannot be written");
  expect(why_not_kept(view({ result, file: { camera: "c", refusal: "", is_saved: true } }))).toMatch(/has this result/);
  expect([why_not_kept(view(null)), why_not_solved(view(null))].every((why) => why !== "")).toBe(true);
});

test("values have as many digits as mean something", () => {
  expect(with_sigma(412.34567, 0.234)).toEqual({ value: "412.35", sigma: "0.23" });
  expect(with_sigma(-0.123456, 0.00123)).toEqual({ value: "−0.1235", sigma: "0.0012" });
  expect(with_sigma(412.3, 15.2)).toEqual({ value: "412", sigma: "15" });
  expect(with_sigma(412.3, 0).sigma).toBe("?");
  expect(with_sigma(412.3, Number.POSITIVE_INFINITY).sigma).toBe("?");
});
