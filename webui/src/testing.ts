import type { ColorTable } from "./colors/classify";
import { color_classes } from "./colors/color_class";
import type { Calibration, View } from "./link/calibration_api";
import type { YuvFrame } from "./link/frame_bytes";
import type { Scene } from "./scene";

// What several tests need; no part of the pages.

/// The same numbers for the same seed, evenly spread. source: "mulberry32", Tommy Ettinger, public domain.
export function numbers_from(seed: number, low: number, high: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return low + ((high - low) * ((t ^ (t >>> 14)) >>> 0)) / 2 ** 32;
  };
}

export function empty_scene(frame = 0): Scene {
  return { frame, t: frame / 20, pose: null, balls: [], goals: [], robots: [], lines: [], free_space: null, tracks: [], why: {}, timing_ms: { total: 1 } };
}

/// A message of /ws/frame.
export function frame_bytes({ width, height, range, frame, t, y, u, v }: YuvFrame): ArrayBuffer {
  const bytes = new Uint8Array(32 + y.length + u.length + v.length);
  const view = new DataView(bytes.buffer);
  bytes.set([...("TYUV")].map((letter) => letter.charCodeAt(0)));
  [width, height, range === "full" ? 1 : 0].forEach((value, i) => view.setUint32(4 + 4 * i, value, true));
  view.setBigInt64(16, BigInt(frame), true);
  view.setFloat64(24, t, true);
  bytes.set(y, 32);
  bytes.set(u, 32 + y.length);
  bytes.set(v, 32 + y.length + u.length);
  return bytes.buffer;
}

/// Every cell with bits, every class with an interval, and a priority of its own.
export function random_table(seed: number): ColorTable {
  const random = numbers_from(seed, 0, 1);
  const classes = color_classes.slice(1);
  const brightness = Object.fromEntries(classes.map((color) => {
    const [a, b] = [Math.floor(256 * random()), Math.floor(256 * random())];
    return [color, [Math.min(a, b), Math.max(a, b)] as const];
  }));
  const priority = classes.map((color) => ({ color, place: random() })).sort((a, b) => a.place - b.place).map(({ color }) => color);
  return { chroma: Uint8Array.from({ length: 65536 }, () => 256 * random()), brightness, priority, range: "limited" };
}

export function random_frame(seed: number, width: number, height: number): YuvFrame {
  const random = numbers_from(seed, 0, 256);
  const fill = (length: number): Uint8Array => Uint8Array.from({ length }, random);
  const chroma = Math.ceil(width / 2) * height;
  return { width, height, range: seed % 2 === 0 ? "limited" : "full", frame: seed, t: seed / 20, y: fill(width * height), u: fill(chroma), v: fill(chroma) };
}

/// Nothing has begun yet.
export const idle_calibration: Calibration = {
  is_on: false, is_automatic: true, is_solving: false, targets: ["dots:7x7:0.04:0.01"], model: "division", width: 640, height: 480, now: null, views: [],
  coverage: { columns: 4, rows: 3, points: new Array<number>(12).fill(0), share: 0 }, result: null, failure: "",
  file: { camera: "camera.yaml", refusal: "", is_saved: false },
};

export function some_view(id: string): View {
  return { id, frame: Number(id), target: "dots:7x7:0.04:0.01", points: [[10, 10], [20, 10], [20, 30]], rms_px: null, rejected: "" };
}
