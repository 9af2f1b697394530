import { expect, test } from "vitest";
import { apply, inverse } from "../canvas/transform";
import type { Point } from "../scene";
import { numbers_from } from "../testing";
import { canvas_from_image, type ImageView, kept_inside, panned, showing, whole_image, zoomed } from "./view_transform";

const image = { width: 640, height: 480 };
const canvas = { width: 900, height: 600 };
const seen = (view: ImageView, point: Point): Point => apply(inverse(canvas_from_image(view, image, canvas)), point);

test("the whole image fits, and its corners are half a pixel outside of the corner pixels' middles", () => {
  const to_canvas = canvas_from_image(whole_image(image), image, canvas);
  expect(apply(to_canvas, [-0.5, -0.5])).toEqual([50, 0]);
  expect(apply(to_canvas, [639.5, 479.5])).toEqual([850, 600]);
});

test("zoomed, what is under the pointer stays there, unless an edge is in the way", () => {
  const random = numbers_from(1, 0, 1);
  for (let n = 0; n < 200; ++n) {
    const view = kept_inside({ center: [640 * random(), 480 * random()], zoom: 2 + 4 * random() }, image, canvas);
    const anchor: Point = [900 * random(), 600 * random()];
    const closer = zoomed(view, 1 + random(), anchor, image, canvas);
    seen(closer, anchor).forEach((value, i) => expect(value).toBeCloseTo(seen(view, anchor)[i]!, 6));
  }
});

test("whatever is done, no edge comes in, and the zoom stays between all and one pixel's detail", () => {
  const random = numbers_from(2, -1, 1);
  let view = whole_image(image);
  for (let n = 0; n < 500; ++n) {
    const anchor: Point = [450 + 450 * random(), 300 + 300 * random()];
    view = n % 2 === 0 ? zoomed(view, Math.exp(2 * random()), anchor, image, canvas) : panned(view, [900 * random(), 600 * random()], image, canvas);
    expect(view.zoom).toBeGreaterThanOrEqual(1);
    expect(view.zoom).toBeLessThanOrEqual(40);
    const [x0, y0] = seen(view, [0, 0]);
    const [x1, y1] = seen(view, [900, 600]);
    if (y1 - y0 <= 480) expect(y0 >= -0.5 - 1e-6 && y1 <= 479.5 + 1e-6).toBe(true);
    if (x1 - x0 <= 640) expect(x0 >= -0.5 - 1e-6 && x1 <= 639.5 + 1e-6).toBe(true);
  }
});

test("a point of the image can be brought into sight", () => {
  const random = numbers_from(3, 0, 1);
  for (let n = 0; n < 100; ++n) {
    const point: Point = [639 * random(), 479 * random()];
    const view = showing(kept_inside({ center: [320, 240], zoom: 10 }, image, canvas), point, image, canvas);
    const [x, y] = apply(canvas_from_image(view, image, canvas), point);
    expect(x >= -1e-6 && x <= 900 + 1e-6 && y >= -1e-6 && y <= 600 + 1e-6).toBe(true);
  }
});
