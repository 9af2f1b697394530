import type { YuvFrame } from "../link/frame_bytes";
import { type ColorClass, label_of } from "./color_class";

/// Lowest and highest Y, both belong to it; low > high is empty.
export type Interval = readonly [number, number];

/// Which colors are which class.
export interface ColorTable {
  /// Cell (U, V) at V * 256 + U; bit 0 black .. bit 7 yellow.
  readonly chroma: Uint8Array;
  /// A class that is missing is empty.
  readonly brightness: Readonly<Partial<Record<ColorClass, Interval>>>;
  readonly priority: readonly ColorClass[];
  readonly range: "limited" | "full";
}

/// The label of one pixel by definition: that of the first class of the priority whose bit its cell has and whose brightness holds its Y.
export function classify(table: ColorTable, y: number, u: number, v: number): number {
  const bits = table.chroma[v * 256 + u]!;
  for (const color of table.priority) {
    const interval = table.brightness[color];
    const label = label_of(color);
    if (label > 0 && (bits & (1 << (label - 1))) !== 0 && interval !== undefined && interval[0] <= y && y <= interval[1]) return label;
  }
  return 0;
}

/// A table made ready for whole frames. A cell's label depends only on its bits and Y, so all there is to know are 256 x 256 labels:
/// one look at the cell, one at the label.
export class Classifier {
  private readonly labels = new Uint8Array(256 * 256);   // bits * 256 + Y

  constructor(readonly table: ColorTable) {
    // From the last of the priority to the first: the first has the last word.
    for (const color of [...table.priority].reverse()) {
      const interval = table.brightness[color];
      const label = label_of(color);
      if (interval === undefined || label === 0) continue;
      const [low, high] = [Math.max(interval[0], 0), Math.min(interval[1], 255)];
      if (low > high) continue;
      for (let bits = 0; bits < 256; ++bits) {
        if ((bits & (1 << (label - 1))) !== 0) this.labels.fill(label, bits * 256 + low, bits * 256 + high + 1);
      }
    }
  }

  label(y: number, u: number, v: number): number {
    return this.labels[this.table.chroma[v * 256 + u]! * 256 + y]!;
  }

  /// Labels of all pixels, row by row. `recycled` is used again when it has the right length. Some ms for 640 x 480.
  frame(frame: YuvFrame, recycled?: Uint8Array): Uint8Array {
    const { width, height, y, u, v } = frame;
    const out = recycled?.length === y.length ? recycled : new Uint8Array(y.length);
    const { labels } = this;
    const { chroma } = this.table;
    const chroma_width = (width + 1) >> 1;
    for (let row = 0; row < height; ++row) {
      const begin = row * width;
      for (let c = 0, at = row * chroma_width; c < width; c += 2, ++at) {
        const bits = chroma[(v[at]! << 8) | u[at]!]! << 8;
        out[begin + c] = labels[bits | y[begin + c]!]!;
        if (c + 1 < width) out[begin + c + 1] = labels[bits | y[begin + c + 1]!]!;
      }
    }
    return out;
  }
}

/// How many pixels have another label.
export function count_changed(before: Uint8Array, after: Uint8Array): number {
  let changed = 0;
  for (let i = 0; i < after.length; ++i) changed += before[i] === after[i] ? 0 : 1;
  return changed;
}
