import { type Affine, inverse, apply, type Size } from "../canvas/transform";
import type { Point } from "../scene";

/// What of an image is seen: a point of it in the middle of the canvas, and how much larger than fitting.
export interface ImageView {
  readonly center: Point;
  readonly zoom: number;
}

/// One pixel of the image is then as large as a fingertip.
const largest_zoom = 40;

export function whole_image(image: Size): ImageView {
  return { center: [image.width / 2 - 0.5, image.height / 2 - 0.5], zoom: 1 };
}

/// Image points, whose pixels' middles are whole numbers, to the canvas.
export function canvas_from_image({ center, zoom }: ImageView, image: Size, canvas: Size): Affine {
  const s = zoom * Math.min(canvas.width / image.width, canvas.height / image.height);
  return { a: s, b: 0, c: 0, d: s, e: canvas.width / 2 - s * center[0], f: canvas.height / 2 - s * center[1] };
}

/// No edge of the image comes into the canvas while there is more of it to see.
export function kept_inside({ center, zoom }: ImageView, image: Size, canvas: Size): ImageView {
  const z = Math.min(Math.max(zoom, 1), largest_zoom);
  const s = z * Math.min(canvas.width / image.width, canvas.height / image.height);
  const keep = (value: number, side: number, seen: number): number => {
    const half = Math.min(seen / s / 2, side / 2);
    return Math.min(Math.max(value, half - 0.5), side - half - 0.5);
  };
  return { center: [keep(center[0], image.width, canvas.width), keep(center[1], image.height, canvas.height)], zoom: z };
}

/// The image point under `anchor`, a point of the canvas, stays there as far as the image's edges allow.
export function zoomed(view: ImageView, factor: number, anchor: Point, image: Size, canvas: Size): ImageView {
  const zoom = Math.min(Math.max(view.zoom * factor, 1), largest_zoom);
  const [x, y] = apply(inverse(canvas_from_image(view, image, canvas)), anchor);
  const s = zoom * Math.min(canvas.width / image.width, canvas.height / image.height);
  return kept_inside({ center: [x + (canvas.width / 2 - anchor[0]) / s, y + (canvas.height / 2 - anchor[1]) / s], zoom }, image, canvas);
}

/// By so many pixels of the canvas.
export function panned(view: ImageView, by: Point, image: Size, canvas: Size): ImageView {
  const s = canvas_from_image(view, image, canvas).a;
  return kept_inside({ ...view, center: [view.center[0] - by[0] / s, view.center[1] - by[1] / s] }, image, canvas);
}

/// The least pan that shows a point of the image, with some room around it.
export function showing(view: ImageView, [x, y]: Point, image: Size, canvas: Size): ImageView {
  const s = canvas_from_image(view, image, canvas).a;
  const room = (seen: number): number => (0.4 * seen) / s;
  const pull = (value: number, to: number, most: number): number => Math.min(Math.max(value, to - most), to + most);
  return kept_inside({ ...view, center: [pull(view.center[0], x, room(canvas.width)), pull(view.center[1], y, room(canvas.height))] }, image, canvas);
}
