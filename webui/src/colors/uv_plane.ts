import type { ColorTable } from "./classify";
import { type ColorClass, color_classes, label_of, line_color, type Rgb } from "./color_class";
import { rgb_of } from "./paint";

export interface UvPicture {
  readonly table: ColorTable | null;
  /// Of the class `color`, by cell V * 256 + U; null: not known.
  readonly density: Uint8Array | null;
  readonly color: ColorClass;
}

/// The classes that a cell may belong to, in the order of their labels.
export function classes_of_cell(table: ColorTable, u: number, v: number): ColorClass[] {
  const bits = table.chroma[v * 256 + u]!;
  return color_classes.filter((_, label) => label > 0 && (bits & (1 << (label - 1))) !== 0);
}

/// Every cell in its own color: dim where the class was not seen, and brighter by the logarithm of how often. 256 x 256 packed pixels, V up.
export function paint_plane(density: Uint8Array | null, range: "limited" | "full", out: Uint32Array): void {
  for (let v = 0, i = 0; v < 256; ++v) {
    for (let u = 0; u < 256; ++u, ++i) {
      const seen = density?.[i] ?? 0;
      const [r, g, b] = rgb_of(seen === 0 ? 56 : 96, u, v, range);
      // Towards white, so that gray cells, and those that are bright anyway, are told apart too.
      const white = seen === 0 ? 0 : 0.15 + (0.75 * seen) / 255;
      const mix = (value: number): number => Math.round(value + white * (255 - value));
      out[(255 - v) * 256 + u] = ((255 << 24) | (mix(b) << 16) | (mix(g) << 8) | mix(r)) >>> 0;
    }
  }
}

/// Edges of a class's cells, as lines between corners of cells, V up: x0, y0, x1, y1 after each other. Neighbors in a row are one line.
export function outline_of(table: ColorTable, color: ColorClass): number[] {
  const bit = 1 << (label_of(color) - 1);
  const has = (u: number, v: number): boolean => u >= 0 && u < 256 && v >= 0 && v < 256 && (table.chroma[v * 256 + u]! & bit) !== 0;
  const lines: number[] = [];
  for (let edge = 0; edge <= 256; ++edge) {
    let [row_begin, column_begin] = [-1, -1];
    for (let i = 0; i <= 256; ++i) {
      const on_row = i < 256 && has(i, edge) !== has(i, edge - 1);
      if (on_row && row_begin < 0) row_begin = i;
      if (!on_row && row_begin >= 0) {
        lines.push(row_begin, 256 - edge, i, 256 - edge);
        row_begin = -1;
      }
      const on_column = i < 256 && has(edge, i) !== has(edge - 1, i);
      if (on_column && column_begin < 0) column_begin = i;
      if (!on_column && column_begin >= 0) {
        lines.push(edge, 256 - column_begin, edge, 256 - i);
        column_begin = -1;
      }
    }
  }
  return lines;
}

/// How much of the plane is seen: a square of cells.
export interface UvWindow {
  readonly u: number;
  readonly v: number;
  readonly side: number;
}

export const whole_plane: UvWindow = { u: 0, v: 0, side: 256 };

/// The least square, not too small, with all that is of a class or was seen; what lies beyond is nobody's.
export function used_window({ table, density }: UvPicture): UvWindow {
  let [u0, u1, v0, v1] = [256, -1, 256, -1];
  for (let v = 0, i = 0; v < 256; ++v) {
    for (let u = 0; u < 256; ++u, ++i) {
      if ((table?.chroma[i] ?? 0) === 0 && (density?.[i] ?? 0) === 0) continue;
      [u0, u1, v0, v1] = [Math.min(u0, u), Math.max(u1, u), v < v0 ? v : v0, v > v1 ? v : v1];
    }
  }
  if (u1 < 0) return whole_plane;
  const side = Math.min(Math.max(u1 - u0, v1 - v0, 56) + 9, 256);
  const begin = (low: number, high: number): number => Math.min(Math.max(Math.round((low + high + 1 - side) / 2), 0), 256 - side);
  return { u: begin(u0, u1), v: begin(v0, v1), side };
}

/// The plane's own canvas, painted anew only when density or range are others, and the way it is drawn.
export class UvPlane {
  private readonly plane = document.createElement("canvas");
  private painted: { density: Uint8Array | null; range: string } | null = null;
  private outlines = new Map<ColorClass, number[]>();
  private outlined: ColorTable | null = null;

  draw(context: CanvasRenderingContext2D, size: number, picture: UvPicture, window: UvWindow, mark: { u: number; v: number } | null): void {
    const range = picture.table?.range ?? "limited";
    this.repaint(picture.density, range);
    const scale = size / window.side;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.imageSmoothingEnabled = false;
    const top = 256 - window.v - window.side;
    context.drawImage(this.plane, window.u, top, window.side, window.side, 0, 0, size, size);
    context.setTransform(scale, 0, 0, scale, -scale * window.u, -scale * top);
    if (picture.table !== null) this.draw_classes(context, picture.table, picture.color, size / 320 / scale);
    context.setTransform(1, 0, 0, 1, 0, 0);
    if (mark !== null) draw_mark(context, scale * (mark.u + 0.5 - window.u), scale * (255.5 - mark.v - top), size / 320);
  }

  private repaint(density: Uint8Array | null, range: "limited" | "full"): void {
    if (this.painted !== null && this.painted.density === density && this.painted.range === range) return;
    this.painted = { density, range };
    this.plane.width = this.plane.height = 256;
    const context = this.plane.getContext("2d", { alpha: false })!;
    const image = context.createImageData(256, 256);
    paint_plane(density, range, new Uint32Array(image.data.buffer));
    context.putImageData(image, 0, 0);
  }

  /// line  [cells]
  private draw_classes(context: CanvasRenderingContext2D, table: ColorTable, chosen: ColorClass, line: number): void {
    if (this.outlined !== table) {
      this.outlined = table;
      this.outlines = new Map(color_classes.slice(1).map((color) => [color, outline_of(table, color)]));
    }
    // The chosen one last, over the others.
    const order = [...this.outlines.keys()].sort((a, b) => Number(a === chosen) - Number(b === chosen));
    for (const color of order) {
      const lines = this.outlines.get(color)!;
      if (lines.length === 0) continue;
      context.beginPath();
      for (let i = 0; i < lines.length; i += 4) {
        context.moveTo(lines[i]!, lines[i + 1]!);
        context.lineTo(lines[i + 2]!, lines[i + 3]!);
      }
      const [r, g, b]: Rgb = line_color(label_of(color));
      context.lineCap = "square";
      context.strokeStyle = "rgb(0 0 0 / 0.75)";
      context.lineWidth = (color === chosen ? 4.5 : 2.6) * line;
      context.stroke();
      context.strokeStyle = `rgb(${r} ${g} ${b})`;
      context.lineWidth = (color === chosen ? 2.4 : 1.2) * line;
      context.stroke();
    }
  }
}

function draw_mark(context: CanvasRenderingContext2D, x: number, y: number, px: number): void {
  for (const [color, width] of [["rgb(0 0 0 / 0.8)", 4], ["#fff", 1.75]] as const) {
    context.beginPath();
    context.arc(x, y, 6 * px, 0, 2 * Math.PI);
    context.strokeStyle = color;
    context.lineWidth = width * px;
    context.stroke();
  }
}

/// The cell under a point of the drawing, which is `size` wide.
export function cell_at(x: number, y: number, size: number, window: UvWindow): { u: number; v: number } {
  const clip = (value: number): number => Math.min(Math.max(Math.floor(value), 0), 255);
  return { u: clip(window.u + (x / size) * window.side), v: clip(window.v + (1 - y / size) * window.side) };
}
