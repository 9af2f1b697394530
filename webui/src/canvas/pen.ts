import type { Point } from "../scene";
import { type Affine, apply, type Size } from "./transform";
import { type Ellipse, ellipse_points } from "./ellipse";

/// The colors of a view; they follow the page's light or dark.
export interface Palette {
  readonly ground: string;
  readonly grid: string;
  readonly text: string;
  readonly faint: string;
  readonly line: string;
  readonly boundary: string;
  readonly free: string;
  readonly blocked: string;
  readonly ball: string;
  readonly cyan: string;
  readonly magenta: string;
  readonly unknown: string;
  readonly yellow: string;
  readonly blue: string;
  readonly self: string;
}

export const palette_names: readonly (keyof Palette)[] = [
  "ground", "grid", "text", "faint", "line", "boundary", "free", "blocked", "ball", "cyan", "magenta", "unknown", "yellow", "blue", "self",
];

/// From the custom properties --canvas-ground, ... of an element.
export function palette_of(element: Element): Palette {
  const style = getComputedStyle(element);
  return Object.fromEntries(palette_names.map((name) => [name, style.getPropertyValue(`--canvas-${name}`).trim()])) as unknown as Palette;
}

/// The part of a canvas's context that is drawn with.
export type Canvas2D = Pick<
  CanvasRenderingContext2D,
  | "beginPath" | "moveTo" | "lineTo" | "closePath" | "arc" | "fill" | "stroke" | "fillRect" | "fillText" | "measureText" | "setLineDash"
  | "fillStyle" | "strokeStyle" | "lineWidth" | "globalAlpha" | "font" | "textAlign" | "textBaseline" | "lineJoin" | "lineCap"
>;

/// Half the height of a digit, of a font's height.
const digit_share = 0.36;

/// Draws in meters of a frame; widths and letters keep their size on the screen.
export class Pen {
  constructor(
    readonly context: Canvas2D,
    readonly size: Size,
    readonly transform: Affine,
    readonly palette: Palette,
    /// Pixels of the canvas for one of the page.
    readonly density: number,
    /// Of all that it draws: less than 1 fades.
    readonly opacity = 1,
  ) {
    context.lineJoin = "round";
    context.lineCap = "round";
    context.globalAlpha = 1;
    context.setLineDash([]);
  }

  /// The same canvas, in another frame.
  within(transform: Affine, opacity = this.opacity): Pen {
    return new Pen(this.context, this.size, transform, this.palette, this.density, opacity);
  }

  clear(): void {
    this.context.fillStyle = this.palette.ground;
    this.context.fillRect(0, 0, this.size.width, this.size.height);
  }

  at(point: Point): Point {
    return apply(this.transform, point);
  }

  private trace(points: readonly Point[], closed: boolean): void {
    this.context.beginPath();
    points.forEach((point, i) => {
      const [x, y] = this.at(point);
      if (i === 0) this.context.moveTo(x, y);
      else this.context.lineTo(x, y);
    });
    if (closed) this.context.closePath();
  }

  line(points: readonly Point[], color: string, width = 1.5, dash: readonly number[] = []): void {
    this.trace(points, false);
    this.stroke(color, width, dash);
  }

  outline(points: readonly Point[], color: string, width = 1.5, dash: readonly number[] = []): void {
    this.trace(points, true);
    this.stroke(color, width, dash);
  }

  area(points: readonly Point[], color: string, alpha = 1): void {
    this.trace(points, true);
    this.fill(color, alpha);
  }

  circle(center: Point, radius: number, color: string, width = 1.5, dash: readonly number[] = []): void {
    this.outline(ellipse_points({ center, major: radius, minor: radius, angle: 0 }, 72), color, width, dash);
  }

  ellipse(ellipse: Ellipse | null, color: string, alpha = 0.18): void {
    if (ellipse === null) return;
    const points = ellipse_points(ellipse);
    this.area(points, color, alpha);
    this.outline(points, color, 1);
  }

  /// A disc as large as the thing, but never too small to see, [m] and pixels of the page.
  disc(center: Point, radius: number, least_px: number, color: string): void {
    const [x, y] = this.at(center);
    const unit = Math.hypot(this.transform.a, this.transform.b);
    this.context.beginPath();
    this.context.arc(x, y, Math.max(radius * unit, least_px * this.density), 0, 2 * Math.PI);
    this.fill(color, 1);
  }

  ring(center: Point, radius: number, least_px: number, color: string, width = 1.5, dash: readonly number[] = []): void {
    const [x, y] = this.at(center);
    const unit = Math.hypot(this.transform.a, this.transform.b);
    this.context.beginPath();
    this.context.arc(x, y, Math.max(radius * unit, least_px * this.density), 0, 2 * Math.PI);
    this.stroke(color, width, dash);
  }

  arrow(from: Point, to: Point, color: string): void {
    const [x0, y0] = this.at(from);
    const [x1, y1] = this.at(to);
    const length = Math.hypot(x1 - x0, y1 - y0);
    if (length < 4 * this.density) return;   // too slow to see, and its direction is noise
    const head = Math.min(7 * this.density, length / 2);
    const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
    const c = this.context;
    c.beginPath();
    c.moveTo(x0, y0);
    c.lineTo(x1, y1);
    c.moveTo(x1 - head * (ux - 0.5 * uy), y1 - head * (uy + 0.5 * ux));
    c.lineTo(x1, y1);
    c.lineTo(x1 - head * (ux + 0.5 * uy), y1 - head * (uy - 0.5 * ux));
    this.stroke(color, 2, []);
  }

  /// Beside a point, on a ground of its own so that it can be read over anything; kept within the canvas.
  label(text: string, beside: Point, color: string, shift_px: Point = [9, 0]): void {
    const c = this.context;
    const d = this.density;
    c.font = `600 ${12 * d}px system-ui, sans-serif`;
    c.textAlign = "left";
    c.textBaseline = "middle";
    const width = c.measureText(text).width;
    const [px, py] = this.at(beside);
    const x = Math.min(Math.max(px + shift_px[0] * d, 4 * d), this.size.width - width - 4 * d);
    const y = Math.min(Math.max(py + shift_px[1] * d, 10 * d), this.size.height - 10 * d);
    c.globalAlpha = 0.75 * this.opacity;
    c.fillStyle = this.palette.ground;
    c.fillRect(x - 3 * d, y - 8 * d, width + 6 * d, 16 * d);
    c.globalAlpha = this.opacity;
    c.fillStyle = color;
    c.fillText(text, x, y);
    c.globalAlpha = 1;
  }

  /// In the middle of a thing, without a ground of its own.
  inscribe(text: string, at: Point, color: string, height_px: number): void {
    const c = this.context;
    c.font = `700 ${height_px * this.density}px system-ui, sans-serif`;
    c.textAlign = "center";
    c.textBaseline = "alphabetic";
    c.fillStyle = color;
    const [x, y] = this.at(at);
    c.globalAlpha = this.opacity;
    c.fillText(text, x, y + digit_share * height_px * this.density);
    c.globalAlpha = 1;
  }

  /// A small mark of a scale.
  note(text: string, at: Point): void {
    const c = this.context;
    c.font = `${11 * this.density}px system-ui, sans-serif`;
    c.textAlign = "center";
    c.textBaseline = "bottom";
    c.fillStyle = this.palette.faint;
    const [x, y] = this.at(at);
    c.fillText(text, x, y - 2 * this.density);
  }

  private stroke(color: string, width: number, dash: readonly number[]): void {
    this.context.setLineDash(dash.map((part) => part * this.density));
    this.context.strokeStyle = color;
    this.context.lineWidth = width * this.density;
    this.context.globalAlpha = this.opacity;
    this.context.stroke();
    this.context.globalAlpha = 1;
  }

  private fill(color: string, alpha: number): void {
    this.context.globalAlpha = alpha * this.opacity;
    this.context.fillStyle = color;
    this.context.fill();
    this.context.globalAlpha = 1;
  }
}
