import type { ColorTable, Interval } from "../colors/classify";
import { type ColorClass, color_classes } from "../colors/color_class";
import type { Draft, Sample } from "../colors/draft";
import { ask, type Option, patience_ms, Refused, with_json } from "./api";
import { parse_frame, type YuvFrame } from "./frame_bytes";

// The requests of color training; public/openapi.yaml documents them.

export interface ImageEntry {
  readonly id: string;
  readonly name: string;
  readonly width: number;
  readonly height: number;
  /// It is in a file; others are gone with the server until they are saved with a sample.
  readonly kept: boolean;
}

export interface ClassQuality {
  readonly precision?: number | null;
  readonly recall?: number | null;
  readonly pixels?: number;
}
export type QualityByClass = Readonly<Partial<Record<ColorClass, ClassQuality>>>;

export interface PastTable {
  readonly id: string;
  readonly date: string;
  readonly notes: string;
  readonly in_use: boolean;
  readonly quality: QualityByClass;
}

export interface Training {
  readonly version: number;
  readonly is_saved: boolean;
  readonly range: "limited" | "full";
  readonly files: { readonly samples: string; readonly colors: string; readonly images: string; readonly refusal: string };
  readonly images: readonly ImageEntry[];
  readonly samples: readonly Sample[];
  readonly options: readonly Option[];
  readonly brightness: Readonly<Partial<Record<ColorClass, Interval>>>;
  /// Newest first.
  readonly history: readonly PastTable[];
}

export interface Quality {
  /// Of the draft that was judged last.
  readonly version: number | null;
  readonly is_running: boolean;
  readonly classes: QualityByClass;
}

export interface Seen {
  readonly class: ColorClass;
  /// By cell V * 256 + U: 0 no pixel, else by the logarithm of how many.
  readonly density: Uint8Array;
  /// Pixels in the fullest cell, density 255.
  readonly most: number;
  /// Pixels by Y.
  readonly brightness: readonly number[];
}

export interface Result {
  readonly version: number;
  readonly table: ColorTable;
  readonly classes: readonly { readonly class: ColorClass; readonly samples: number; readonly pixels: number }[];
  readonly seen: Seen | null;
  readonly warnings: readonly string[];
}

export interface TrainingApi {
  training(): Promise<Training>;
  /// Refused with 409 when `version` is not the server's.
  put_draft(version: number, draft: Draft, seen: ColorClass): Promise<Result>;
  result(seen: ColorClass): Promise<Result>;
  quality(): Promise<Quality>;
  table(): Promise<ColorTable>;
  keep(frame: number | null): Promise<ImageEntry>;
  pixels(id: string): Promise<YuvFrame>;
  forget(id: string): Promise<Training>;
  save(version: number, notes: string): Promise<Training>;
  restore(id: string): Promise<Training>;
}

const cells = 65536;

function bytes_of(text: unknown, what: string): Uint8Array {
  if (typeof text !== "string") throw new Error(`${what}: is no text`);
  let binary: string;
  try {
    binary = atob(text);
  } catch {
    throw new Error(`${what}: is no base64`);
  }
  if (binary.length !== cells) throw new Error(`${what}: has ${binary.length} bytes, must have ${cells}`);
  const bytes = new Uint8Array(cells);
  for (let i = 0; i < cells; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

type Told<T, Replaced> = Omit<T, keyof Replaced> & Replaced;
export type ToldTable = Told<ColorTable, { chroma: string }>;
export type ToldResult = Told<Result, { table: ToldTable; seen: Told<Seen, { density: string }> | null }>;

/// Throws when a table is none: with a wrong one, pictures would be wrong without a word.
export function table_of(told: ToldTable): ColorTable {
  for (const color of told.priority) if (!color_classes.includes(color)) throw new Error(`priority: '${color}' is no class`);
  return { ...told, chroma: bytes_of(told.chroma, "chroma") };
}

export function result_of(told: ToldResult): Result {
  const { seen } = told;
  if (seen !== null && seen.brightness.length !== 256) throw new Error(`brightness: has ${seen.brightness.length} numbers, must have 256`);
  return { ...told, table: table_of(told.table), seen: seen === null ? null : { ...seen, density: bytes_of(seen.density, "density") } };
}

async function ask_frame(path: string): Promise<YuvFrame> {
  const response = await fetch(path, { cache: "no-store", signal: AbortSignal.timeout(4 * patience_ms) });
  if (!response.ok) throw new Refused(response.status, (await response.text()).trim() || `the server answers ${response.status}`);
  return parse_frame(await response.arrayBuffer());
}

const base = "/api/training";

export const server_training: TrainingApi = {
  training: () => ask(base),
  put_draft: async (version, draft, seen) => result_of(await ask(`${base}/draft?class=${seen}`, with_json("PUT", { version, ...draft }))),
  result: async (seen) => result_of(await ask(`${base}/result?class=${seen}`)),
  quality: () => ask(`${base}/quality`),
  table: async () => table_of(await ask(`${base}/table`)),
  keep: (frame) => ask(`${base}/images`, with_json("POST", { frame })),
  pixels: (id) => ask_frame(`${base}/images/${encodeURIComponent(id)}`),
  forget: (id) => ask(`${base}/images/${encodeURIComponent(id)}`, { method: "DELETE" }),
  save: (version, notes) => ask(`${base}/save`, with_json("POST", { version, notes })),
  restore: (id) => ask(`${base}/restore`, with_json("POST", { id })),
};
