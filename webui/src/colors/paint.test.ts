import { describe, expect, test } from "vitest";
import { random_frame, random_table } from "../testing";
import { Classifier, count_changed } from "./classify";
import { label_colors } from "./color_class";
import { cover_labels, paint_difference, paint_labels, paint_luma, paint_rgb, rgb_of } from "./paint";

const channels = (pixel: number): number[] => [pixel & 255, (pixel >>> 8) & 255, (pixel >>> 16) & 255, pixel >>> 24];

describe("YUV to RGB", () => {
  test("gray has no color, and the ends of the range are black and white", () => {
    expect(rgb_of(16, 128, 128, "limited")).toEqual([0, 0, 0]);
    expect(rgb_of(235, 128, 128, "limited")).toEqual([255, 255, 255]);
    expect(rgb_of(0, 128, 128, "full")).toEqual([0, 0, 0]);
    expect(rgb_of(255, 128, 128, "full")).toEqual([255, 255, 255]);
    expect(rgb_of(0, 128, 128, "limited")).toEqual([0, 0, 0]);
  });

  test("the primary colors of BT.601 come back", () => {
    // ITU-R BT.601: 8 bit values of 100 % red, green and blue
    for (const [yuv, rgb] of [[[81, 90, 240], [255, 0, 0]], [[145, 54, 34], [0, 255, 0]], [[41, 240, 110], [0, 0, 255]]] as const) {
      rgb_of(...(yuv as unknown as [number, number, number]), "limited").forEach((value, i) => expect(Math.abs(value - rgb[i]!)).toBeLessThanOrEqual(2));
    }
  });

  test("whole frames equal single pixels, by at most one step", () => {
    for (let seed = 0; seed < 6; ++seed) {
      const frame = random_frame(seed, 13 + seed, 9);
      const out = new Uint32Array(frame.y.length);
      paint_rgb(frame, out);
      for (let i = 0; i < out.length; ++i) {
        const [c, row] = [i % frame.width, Math.floor(i / frame.width)];
        const at = row * Math.ceil(frame.width / 2) + (c >> 1);
        const expected = [...rgb_of(frame.y[i]!, frame.u[at]!, frame.v[at]!, frame.range), 255];
        channels(out[i]!).forEach((value, k) => expect(Math.abs(value - expected[k]!)).toBeLessThanOrEqual(1));
      }
    }
  });
});

test("labels have their colors; over a picture by opacity, and no_color leaves it as it is", () => {
  const frame = random_frame(3, 20, 10);
  const labels = new Classifier(random_table(3)).frame(frame);
  const [below, plain] = [new Uint32Array(200), new Uint32Array(200)];
  paint_luma(frame, below);
  paint_labels(labels, plain);
  labels.forEach((label, i) => expect(channels(plain[i]!)).toEqual([...label_colors[label]!, 255]));
  for (const opacity of [0, 0.3, 1]) {
    const out = below.slice();
    cover_labels(labels, opacity, out);
    labels.forEach((label, i) => {
      const share = label === 0 ? 0 : opacity;
      const expected = label_colors[label]!.map((color, k) => share * color + (1 - share) * channels(below[i]!)[k]!);
      channels(out[i]!).slice(0, 3).forEach((value, k) => expect(Math.abs(value - expected[k]!)).toBeLessThanOrEqual(1.5));
      expect(out[i]! >>> 24).toBe(255);
    });
  }
});

test("the difference picture counts what changed, and shows the new class there", () => {
  const frame = random_frame(4, 33, 17);
  const [before, after] = [7, 8].map((seed) => new Classifier(random_table(seed)).frame(frame)) as [Uint8Array, Uint8Array];
  const out = new Uint32Array(frame.y.length);
  expect(paint_difference(frame, before, after, out)).toBe(count_changed(before, after));
  after.forEach((label, i) => {
    if (label !== before[i] && label > 0) expect(channels(out[i]!)).toEqual([...label_colors[label]!, 255]);
  });
  expect(paint_difference(frame, after, after, out)).toBe(0);
});
