import type { Point } from "../scene";
import { ask, patience_ms, Refused, with_json } from "./api";

// The requests of the camera's calibration; public/openapi.yaml documents them.

export const lens_models = ["division", "plumb_bob", "equidistant"] as const;
export type LensModel = (typeof lens_models)[number];

/// The frame that was looked at last.
export interface Now {
  readonly frame: number;
  /// That was found, or null.
  readonly target: string | null;
  /// [px]
  readonly points: readonly Point[];
  readonly verdict: string;
  readonly is_captured: boolean;
}

export interface View {
  readonly id: string;
  readonly frame: number;
  readonly target: string;
  /// [px]
  readonly points: readonly Point[];
  /// Of the result; null before.
  readonly rms_px: number | null;
  /// Why the result does not use it; empty when it does.
  readonly rejected: string;
}

/// Points of all views, in equal cells of the image, row by row.
export interface Coverage {
  readonly columns: number;
  readonly rows: number;
  readonly points: readonly number[];
  /// Of the cells that have points, 0 .. 1.
  readonly share: number;
}

export interface CalibrationResult {
  readonly model: string;
  readonly views: number;
  readonly rms_px: number;
  readonly cross_validated_rms_px: number | null;
  readonly worst_sigma_px: number | null;
  readonly values: readonly { readonly name: string; readonly value: number; readonly sigma: number }[];
  readonly warnings: readonly string[];
}

export interface Calibration {
  readonly is_on: boolean;
  readonly is_automatic: boolean;
  readonly is_solving: boolean;
  readonly targets: readonly string[];
  readonly model: LensModel;
  /// Of the frames. [px]
  readonly width: number;
  readonly height: number;
  readonly now: Now | null;
  /// In the order in which they were captured.
  readonly views: readonly View[];
  readonly coverage: Coverage;
  readonly result: CalibrationResult | null;
  /// Why the last try to work the camera out failed; empty when it did not.
  readonly failure: string;
  readonly file: { readonly camera: string; readonly refusal: string; readonly is_saved: boolean };
}

export interface CalibrationChange {
  readonly is_on?: boolean;
  readonly targets?: readonly string[];
  readonly model?: LensModel;
  readonly is_automatic?: boolean;
}

export interface CalibrationApi {
  calibration(): Promise<Calibration>;
  change(change: CalibrationChange): Promise<Calibration>;
  capture(): Promise<Calibration>;
  forget(id: string): Promise<Calibration>;
  forget_all(): Promise<Calibration>;
  solve(): Promise<Calibration>;
  save(): Promise<Calibration>;
  residuals(): Promise<Blob>;
}

// What is drawn and computed with is checked; with a wrong answer the page would be wrong without a word.

type Told = Record<string, unknown>;

function fail(what: string, must: string): never {
  throw new Error(`calibration: ${what} must be ${must}`);
}

function object(told: unknown, what: string): Told {
  return typeof told === "object" && told !== null && !Array.isArray(told) ? (told as Told) : fail(what, "an object");
}

function list<T>(told: unknown, what: string, item: (told: unknown, what: string) => T): T[] {
  return Array.isArray(told) ? told.map((one, i) => item(one, `${what}[${i}]`)) : fail(what, "a list");
}

function text(told: unknown, what: string): string {
  return typeof told === "string" ? told : fail(what, "a text");
}

function truth(told: unknown, what: string): boolean {
  return typeof told === "boolean" ? told : fail(what, "true or false");
}

function number(told: unknown, what: string): number {
  return typeof told === "number" && Number.isFinite(told) ? told : fail(what, "a number");
}

function count(told: unknown, what: string): number {
  const value = number(told, what);
  return Number.isInteger(value) && value >= 0 ? value : fail(what, "a whole number from 0 on");
}

function or_null<T>(told: unknown, what: string, item: (told: unknown, what: string) => T): T | null {
  return told === null ? null : item(told, what);
}

function point(told: unknown, what: string): Point {
  const pair = list(told, what, number);
  return pair.length === 2 ? [pair[0]!, pair[1]!] : fail(what, "a pair");
}

function now_of(told: unknown, what: string): Now {
  const { frame, target, points, verdict, is_captured } = object(told, what);
  return {
    frame: number(frame, `${what}.frame`),
    target: or_null(target, `${what}.target`, text),
    points: list(points, `${what}.points`, point),
    verdict: text(verdict, `${what}.verdict`),
    is_captured: truth(is_captured, `${what}.is_captured`),
  };
}

function view_of(told: unknown, what: string): View {
  const { id, frame, target, points, rms_px, rejected } = object(told, what);
  return {
    id: text(id, `${what}.id`),
    frame: number(frame, `${what}.frame`),
    target: text(target, `${what}.target`),
    points: list(points, `${what}.points`, point),
    rms_px: or_null(rms_px, `${what}.rms_px`, number),
    rejected: text(rejected, `${what}.rejected`),
  };
}

function coverage_of(told: unknown, what: string): Coverage {
  const { columns, rows, points, share } = object(told, what);
  const coverage = {
    columns: count(columns, `${what}.columns`),
    rows: count(rows, `${what}.rows`),
    points: list(points, `${what}.points`, count),
    share: number(share, `${what}.share`),
  };
  const cells = coverage.columns * coverage.rows;
  return coverage.points.length === cells ? coverage : fail(`${what}.points has ${coverage.points.length} numbers, their number`, `${cells}`);
}

function result_of(told: unknown, what: string): CalibrationResult {
  const { model, views, rms_px, cross_validated_rms_px, worst_sigma_px, values, warnings } = object(told, what);
  return {
    model: text(model, `${what}.model`),
    views: count(views, `${what}.views`),
    rms_px: number(rms_px, `${what}.rms_px`),
    cross_validated_rms_px: or_null(cross_validated_rms_px, `${what}.cross_validated_rms_px`, number),
    worst_sigma_px: or_null(worst_sigma_px, `${what}.worst_sigma_px`, number),
    values: list(values, `${what}.values`, (one, where) => {
      const { name, value, sigma } = object(one, where);
      return { name: text(name, `${where}.name`), value: number(value, `${where}.value`), sigma: number(sigma, `${where}.sigma`) };
    }),
    warnings: list(warnings, `${what}.warnings`, text),
  };
}

/// Throws when it is none, with what is wrong.
export function calibration_of(told: unknown): Calibration {
  const all = object(told, "the answer");
  const { model } = all;
  const file = object(all["file"], "file");
  return {
    is_on: truth(all["is_on"], "is_on"),
    is_automatic: truth(all["is_automatic"], "is_automatic"),
    is_solving: truth(all["is_solving"], "is_solving"),
    targets: list(all["targets"], "targets", text),
    model: lens_models.find((known) => known === model) ?? fail("model", `one of ${lens_models.join(", ")}`),
    width: count(all["width"], "width"),
    height: count(all["height"], "height"),
    now: or_null(all["now"], "now", now_of),
    views: list(all["views"], "views", view_of),
    coverage: coverage_of(all["coverage"], "coverage"),
    result: or_null(all["result"], "result", result_of),
    failure: text(all["failure"], "failure"),
    file: { camera: text(file["camera"], "file.camera"), refusal: text(file["refusal"], "file.refusal"), is_saved: truth(file["is_saved"], "file.is_saved") },
  };
}

const base = "/api/calibration";

async function ask_calibration(path: string, init: RequestInit = {}): Promise<Calibration> {
  return calibration_of(await ask(base + path, init));
}

export const server_calibration: CalibrationApi = {
  calibration: () => ask_calibration(""),
  change: (change) => ask_calibration("", with_json("PUT", change)),
  capture: () => ask_calibration("/views", { method: "POST" }),
  forget: (id) => ask_calibration(`/views/${encodeURIComponent(id)}`, { method: "DELETE" }),
  forget_all: () => ask_calibration("/views", { method: "DELETE" }),
  solve: () => ask_calibration("/solve", { method: "POST" }),
  save: () => ask_calibration("/save", { method: "POST" }),
  residuals: async () => {
    const response = await fetch(`${base}/residuals`, { cache: "no-store", signal: AbortSignal.timeout(4 * patience_ms) });
    if (!response.ok) throw new Refused(response.status, (await response.text()).trim() || `the server answers ${response.status}`);
    return response.blob();
  },
};
