import { describe, expect, test } from "vitest";
import type { Option } from "../link/api";
import { draft_of, empty_draft, options_of, same_draft, type Sample, with_brightness, with_option, with_sample, without_class, without_sample } from "./draft";

const known: Option[] = ["closing_px", "noise_margin"].map((key, i) => (
  { key, unit: "1", low: 0, high: 20, whole: false, meaning: key, default: i + 3, value: i + 3, changed: false }));
const sample = (color: Sample["class"], x = 0): Sample => ({ image: "a", class: color, rectangle: [x, 0, x + 2, 2] });

describe("edits", () => {
  test("leave the draft before as it was, and share what they do not change", () => {
    const before = Object.freeze(with_sample(empty_draft, sample("green")));
    Object.freeze(before.samples);
    const after = with_option(with_brightness(before, "green", [10, 20]), "closing_px", 7);
    expect(after.samples).toBe(before.samples);
    expect(before.brightness).toEqual({});
    expect(with_option(with_brightness(after, "green", null), "closing_px", null)).toEqual(before);
  });

  test("one sample is taken away, not those that look alike", () => {
    const [a, b] = [sample("red"), sample("red")];
    const draft = with_sample(with_sample(empty_draft, a), b);
    expect(without_sample(draft, a).samples).toEqual([b]);
    expect(without_sample(draft, a).samples[0]).toBe(b);
  });

  test("a cleared class has nothing left, others all", () => {
    const draft = with_brightness(with_brightness(with_sample(with_sample(empty_draft, sample("red")), sample("blue")), "red", [1, 2]), "blue", [3, 4]);
    expect(without_class(draft, "red")).toEqual(with_brightness(with_sample(empty_draft, sample("blue")), "blue", [3, 4]));
  });
});

describe("sameness", () => {
  test("does not mind the order of keys, nor defaults that are named", () => {
    const other = { class: "green", rectangle: [0, 0, 2, 2], image: "a" } as const;
    const a = with_sample({ ...empty_draft, brightness: { red: [1, 2], blue: [3, 4] } }, sample("green"));
    const b = with_sample({ ...empty_draft, brightness: { blue: [3, 4], red: [1, 2] }, options: { closing_px: 3 } }, other);
    expect(same_draft(a, b, known)).toBe(true);
    expect(same_draft(draft_of({ ...b, options: options_of(b, known) }), a, known)).toBe(true);
  });

  test("minds everything else", () => {
    const a = with_sample(empty_draft, sample("green"));
    for (const b of [empty_draft, with_sample(empty_draft, sample("red")), with_sample(empty_draft, sample("green", 1)), with_option(a, "closing_px", 4),
                     with_brightness(a, "green", [0, 1]), with_sample(a, sample("green"))]) {
      expect(same_draft(a, b, known)).toBe(false);
    }
  });
});

test("options are shown with the draft's values, and those that are not the default are marked", () => {
  expect(options_of(with_option(empty_draft, "noise_margin", 5), known).map(({ key, value, changed }) => [key, value, changed])).toEqual(
    [["closing_px", 3, false], ["noise_margin", 5, true]]);
});
