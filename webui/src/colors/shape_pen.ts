import { type Affine, apply } from "../canvas/transform";
import type { Point } from "../scene";
import { css_color, label_of, line_color, type ColorClass, type Rgb } from "./color_class";
import type { Begun } from "./drawing";
import { rectangle_between, type ImageSize, type Shape } from "./shapes";

/// Draws samples over a picture: an outline in the color of the class with dark beside it, so that it is seen on anything.
export class ShapePen {
  constructor(
    private readonly context: CanvasRenderingContext2D,
    private readonly canvas_from_image: Affine,
    /// Pixels of the canvas for one of the page.
    private readonly density: number,
  ) {
    context.lineJoin = "round";
    context.lineCap = "round";
  }

  shape(shape: Shape, color: ColorClass, is_selected: boolean): void {
    if ("mask" in shape) return;
    if ("stroke" in shape) return this.stroke(shape.stroke, shape.radius, color, is_selected);
    const corners: readonly Point[] = "polygon" in shape ? shape.polygon : corners_of(shape.rectangle);
    this.path(corners, true);
    this.outline(color, is_selected);
    if (is_selected) for (const corner of corners) this.handle(corner, color);
  }

  begun(begun: Begun, pointer: Point | null, color: ColorClass, size: ImageSize): void {
    switch (begun.tool) {
      case "rectangle": return this.shape(rectangle_between(begun.from, begun.to, size), color, true);
      case "brush": return this.stroke(begun.way, begun.radius, color, true);
      case "polygon":
        this.path(pointer === null ? begun.corners : [...begun.corners, pointer], false);
        this.outline(color, true);
        begun.corners.forEach((corner, i) => this.handle(corner, color, i === 0 ? 6 : 4));
    }
  }

  /// Where the brush would paint.
  brush(at: Point, radius: number, color: ColorClass): void {
    const [x, y] = apply(this.canvas_from_image, at);
    this.context.beginPath();
    this.context.arc(x, y, Math.max(radius * this.canvas_from_image.a, 1), 0, 2 * Math.PI);
    this.outline(color, false);
  }

  cross(at: Point): void {
    const [x, y] = apply(this.canvas_from_image, at);
    const [near, far] = [4 * this.density, 14 * this.density];
    this.context.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
      this.context.moveTo(x + near * dx, y + near * dy);
      this.context.lineTo(x + far * dx, y + far * dy);
    }
    this.twice("#fff", 1.5);
  }

  private stroke(way: readonly Point[], radius: number, color: ColorClass, is_selected: boolean): void {
    const { context } = this;
    this.path(way.length === 1 ? [way[0]!, way[0]!] : way, false);
    context.globalAlpha = is_selected ? 0.5 : 0.25;
    context.lineWidth = 2 * radius * this.canvas_from_image.a;
    context.strokeStyle = css_color(line_color(label_of(color)));
    context.stroke();
    context.globalAlpha = 1;
    this.outline(color, is_selected);
  }

  private handle(at: Point, color: ColorClass, size = 4): void {
    const [x, y] = apply(this.canvas_from_image, at);
    this.context.beginPath();
    this.context.arc(x, y, size * this.density, 0, 2 * Math.PI);
    this.context.fillStyle = "#fff";
    this.context.fill();
    this.twice(css_color(line_color(label_of(color))), 1.5);
  }

  private path(points: readonly Point[], closed: boolean): void {
    this.context.beginPath();
    points.forEach((point, i) => {
      const [x, y] = apply(this.canvas_from_image, point);
      if (i === 0) this.context.moveTo(x, y);
      else this.context.lineTo(x, y);
    });
    if (closed) this.context.closePath();
  }

  private outline(color: ColorClass, is_selected: boolean): void {
    this.twice(css_color(pale(line_color(label_of(color)))), is_selected ? 3 : 1.75);
  }

  private twice(color: string, width: number): void {
    this.context.strokeStyle = "rgb(0 0 0 / 0.7)";
    this.context.lineWidth = (width + 2) * this.density;
    this.context.stroke();
    this.context.strokeStyle = color;
    this.context.lineWidth = width * this.density;
    this.context.stroke();
  }
}

/// On the edges of its pixels.
function corners_of([x0, y0, x1, y1]: readonly [number, number, number, number]): Point[] {
  return [[x0 - 0.5, y0 - 0.5], [x1 - 0.5, y0 - 0.5], [x1 - 0.5, y1 - 0.5], [x0 - 0.5, y1 - 0.5]];
}

/// Seen on the class's own color, too.
function pale([r, g, b]: Rgb): Rgb {
  const half_way = (value: number): number => Math.round((value + 255) / 2);
  return [half_way(r), half_way(g), half_way(b)];
}
