import type { YuvFrame } from "../link/frame_bytes";
import { label_colors, type Rgb } from "./color_class";

// Frames and labels as pixels of a canvas. A pixel is one number, 0xAABBGGRR, as memory has it on every machine that has a browser.

export type Pixels = Uint32Array;

function pixel(r: number, g: number, b: number): number {
  return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
}

function clip(value: number): number {
  return value < 0 ? 0 : value > 255 ? 255 : Math.round(value);
}

/// BT.601, each result rounded and clipped.
export function rgb_of(y: number, u: number, v: number, range: "limited" | "full"): Rgb {
  const [luma, scale] = range === "full" ? [y, 1] : [(255 / 219) * (y - 16), 255 / 224];
  const [cb, cr] = [scale * (u - 128), scale * (v - 128)];
  return [clip(luma + 1.402 * cr), clip(luma - (0.114 * 1.772 * cb + 0.299 * 1.402 * cr) / 0.587), clip(luma + 1.772 * cb)];
}

/// The same for whole frames: sums of looked-up parts in 1/65536.
class RgbParts {
  readonly luma = new Int32Array(256);
  readonly red = new Int32Array(256);
  readonly green_u = new Int32Array(256);
  readonly green_v = new Int32Array(256);
  readonly blue = new Int32Array(256);

  constructor(range: "limited" | "full") {
    const scale = range === "full" ? 1 : 255 / 224;
    const fixed = (value: number): number => Math.round(65536 * value);
    for (let i = 0; i < 256; ++i) {
      const chroma = scale * (i - 128);
      this.luma[i] = fixed(range === "full" ? i : (255 / 219) * (i - 16)) + 32768;
      this.red[i] = fixed(1.402 * chroma);
      this.green_u[i] = fixed((-0.114 * 1.772 * chroma) / 0.587);
      this.green_v[i] = fixed((-0.299 * 1.402 * chroma) / 0.587);
      this.blue[i] = fixed(1.772 * chroma);
    }
  }
}

const parts = { limited: new RgbParts("limited"), full: new RgbParts("full") };
/// Of values from -512 on, [0, 255].
const clipped = Uint8ClampedArray.from({ length: 1536 }, (_, i) => i - 512);

export function paint_rgb({ width, height, range, y, u, v }: YuvFrame, out: Pixels): void {
  const { luma, red, green_u, green_v, blue } = parts[range];
  const chroma_width = (width + 1) >> 1;
  for (let row = 0; row < height; ++row) {
    const begin = row * width;
    for (let c = 0; c < width; ++c) {
      const at = row * chroma_width + (c >> 1);
      const [l, cb, cr] = [luma[y[begin + c]!]!, u[at]!, v[at]!];
      out[begin + c] = 0xff000000 | (clipped[((l + blue[cb]!) >> 16) + 512]! << 16) | (clipped[((l + green_u[cb]! + green_v[cr]!) >> 16) + 512]! << 8)
        | clipped[((l + red[cr]!) >> 16) + 512]!;
    }
  }
}

const grays = Uint32Array.from({ length: 256 }, (_, i) => pixel(i, i, i));

export function paint_luma({ y }: YuvFrame, out: Pixels): void {
  for (let i = 0; i < y.length; ++i) out[i] = grays[y[i]!]!;
}

const label_pixels = Uint32Array.from(label_colors, ([r, g, b]) => pixel(r, g, b));

export function paint_labels(labels: Uint8Array, out: Pixels): void {
  for (let i = 0; i < labels.length; ++i) out[i] = label_pixels[labels[i]!]!;
}

/// Labels over what is there; no_color leaves it. opacity 0 .. 1
export function cover_labels(labels: Uint8Array, opacity: number, out: Pixels): void {
  const share = Math.round(256 * Math.min(Math.max(opacity, 0), 1));
  const kept = 256 - share;
  for (let i = 0; i < labels.length; ++i) {
    const label = labels[i]!;
    if (label === 0) continue;
    const under = out[i]!;
    const over = label_pixels[label]!;
    // Two channels at once: red with blue, then green.
    const rb = (((under & 0xff00ff) * kept + (over & 0xff00ff) * share) >>> 8) & 0xff00ff;
    const g = (((under & 0xff00) * kept + (over & 0xff00) * share) >>> 8) & 0xff00;
    out[i] = 0xff000000 | rb | g;
  }
}

/// What changes its class has the color of the new one, what loses its class is checkered in pink, and all else is a faint picture. Returns how many pixels changed.
export function paint_difference({ width, y }: YuvFrame, before: Uint8Array, after: Uint8Array, out: Pixels): number {
  let changed = 0;
  for (let i = 0; i < y.length; ++i) {
    const label = after[i]!;
    if (label === before[i]) {
      const dim = 24 + (y[i]! >> 2);
      out[i] = grays[dim]!;
      continue;
    }
    ++changed;
    out[i] = label > 0 ? label_pixels[label]! : ((i % width) + Math.floor(i / width)) & 2 ? lost_pixel : grays[40]!;
  }
  return changed;
}

const lost_pixel = pixel(255, 150, 190);
