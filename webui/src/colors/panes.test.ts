import { describe, expect, test } from "vitest";
import { numbers_from } from "../testing";
import { key_target, moved_end } from "./brightness";
import type { Interval } from "./classify";
import { local_time, quality_in_short, why_not_saved } from "./save_pane";

describe("the two thumbs", () => {
  test("stay whole, within 0 .. 255, and never pass each other", () => {
    const random = numbers_from(1, -100, 400);
    let interval: Interval = [20, 200];
    for (let n = 0; n < 1000; ++n) {
      const end = n % 2 === 0 ? 0 : 1;
      const before = interval;
      interval = moved_end(interval, end, random());
      expect(interval[1 - end]).toBe(before[1 - end]);
      expect(interval.every(Number.isInteger) && 0 <= interval[0] && interval[0] <= interval[1] && interval[1] <= 255).toBe(true);
    }
  });

  test("go by one, by ten, and to the ends; other keys are not theirs", () => {
    expect(["ArrowLeft", "ArrowUp", "PageUp", "PageDown"].map((key) => key_target(key, 100))).toEqual([99, 101, 110, 90]);
    expect(moved_end([20, 200], 0, key_target("Home", 20)!)).toEqual([0, 200]);
    expect(moved_end([20, 200], 0, key_target("End", 20)!)).toEqual([200, 200]);
    expect([key_target("5", 100), key_target("u", 100)]).toEqual([null, null]);
  });
});

test("what cannot be saved says why, the most lasting reason first", () => {
  const good = { refusal: "", trouble: "", is_saved: false, samples: 3 };
  expect(why_not_saved(good)).toBe("");
  expect(why_not_saved({ ...good, refusal: "the folder cannot be written", trouble: "away", is_saved: true })).toBe("the folder cannot be written");
  expect(why_not_saved({ ...good, trouble: "away", is_saved: true })).toBe("away");
  expect(why_not_saved({ ...good, is_saved: true })).toMatch(/nothing has changed/);
  expect(why_not_saved({ ...good, samples: 0 })).toMatch(/no samples/);
  expect(why_not_saved({ ...good, refusal: null })).not.toBe("");
});

test("a table's quality in short is that of its worst class", () => {
  expect(quality_in_short({ green: { recall: 0.99, precision: 0.98 }, red: { recall: 0.87, precision: null } })).toBe("worst: red 87.0 %");
  expect(quality_in_short({ green: { recall: null } })).toBe("quality unknown");
});

test("times are read with colons and as names of files have them; what is no time stays as it is", () => {
  const shown = local_time("2026-11-28T00:58:46Z");
  expect(shown).toMatch(/2026/);
  for (const other of ["2026-11-28T00-58-46Z", "2026-11-28T00-58-46Z-2", "2026-11-28T00:58:46.123Z"]) expect(local_time(other)).toBe(shown);
  for (const none of ["", "yesterday", "2026-13-45T99-99-99Z"]) expect(local_time(none)).toBe(none);
});
