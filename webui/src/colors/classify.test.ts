import { describe, expect, test } from "vitest";
import { numbers_from, random_frame, random_table } from "../testing";
import { classify, Classifier, count_changed } from "./classify";

describe("the classifier", () => {
  test("equals the definition for every pixel of random frames and tables, odd widths too", () => {
    for (let seed = 0; seed < 30; ++seed) {
      const table = random_table(seed);
      const classifier = new Classifier(table);
      const frame = random_frame(seed, 1 + (seed % 9), 7);
      const labels = classifier.frame(frame);
      for (let row = 0, i = 0; row < frame.height; ++row) {
        for (let c = 0; c < frame.width; ++c, ++i) {
          const at = row * Math.ceil(frame.width / 2) + Math.floor(c / 2);
          expect(labels[i], `seed ${seed}, pixel ${c}, ${row}`).toBe(classify(table, frame.y[i]!, frame.u[at]!, frame.v[at]!));
        }
      }
    }
  });

  test("equals the definition at the ends of every interval", () => {
    for (let seed = 100; seed < 110; ++seed) {
      const table = random_table(seed);
      const classifier = new Classifier(table);
      const random = numbers_from(seed, 0, 256);
      for (const y of Object.values(table.brightness).flatMap(([low, high]) => [low - 1, low, high, high + 1])) {
        if (y < 0 || y > 255) continue;
        for (let n = 0; n < 50; ++n) {
          const [u, v] = [Math.floor(random()), Math.floor(random())];
          expect(classifier.label(y, u, v)).toBe(classify(table, y, u, v));
        }
      }
    }
  });

  test("a class without brightness, or with an empty one, is nowhere", () => {
    const table = { ...random_table(1), brightness: { green: [20, 10], blue: [0, 255] } as const };
    const labels = new Classifier(table).frame(random_frame(1, 64, 64));
    expect(new Set(labels)).toEqual(new Set([0, 4]));
  });

  test("memory is used again when it fits", () => {
    const classifier = new Classifier(random_table(2));
    const labels = classifier.frame(random_frame(1, 8, 4));
    expect(classifier.frame(random_frame(2, 4, 8), labels)).toBe(labels);
    expect(classifier.frame(random_frame(2, 5, 4), labels)).not.toBe(labels);
  });
});

test("the difference of a table to itself is nothing, and it is the same both ways", () => {
  const frame = random_frame(5, 31, 11);
  const [a, b] = [new Classifier(random_table(5)).frame(frame), new Classifier(random_table(6)).frame(frame)];
  expect(count_changed(a, a)).toBe(0);
  expect(count_changed(a, b)).toBe(count_changed(b, a));
  expect(count_changed(a, b)).toBeGreaterThan(0);
});
