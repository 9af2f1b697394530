import { describe, expect, test } from "vitest";
import { numbers_from } from "../testing";
import { History } from "./history";

describe("undo and redo", () => {
  test("whatever is done, it is what a list of values with a place in it is", () => {
    for (let seed = 0; seed < 20; ++seed) {
      const random = numbers_from(seed, 0, 1);
      let history = History.of(0);
      let [values, at] = [[0], 0];
      for (let n = 1; n < 120; ++n) {
        const what = random();
        if (what < 0.45) {
          history = history.edit(n, `edit ${n}`);
          values = [...values.slice(0, at + 1), n];
          ++at;
        } else if (what < 0.75) {
          history = history.undo();
          at = Math.max(at - 1, 0);
        } else {
          history = history.redo();
          at = Math.min(at + 1, values.length - 1);
        }
        expect(history.present, `seed ${seed}, step ${n}`).toBe(values[at]);
        expect(history.undoes).toBe(at === 0 ? null : `edit ${values[at]}`);
        expect(history.redoes).toBe(at + 1 === values.length ? null : `edit ${values[at + 1]}`);
        expect(values.every((value) => history.some((v) => v === value))).toBe(true);
      }
    }
  });

  test("it goes back ten thousand steps and forward again", () => {
    let history = History.of(0);
    for (let n = 1; n <= 10000; ++n) history = history.edit(n, "");
    for (let n = 9999; n >= 0; --n) expect((history = history.undo()).present).toBe(n);
    expect(history.undo()).toBe(history);
    for (let n = 1; n <= 10000; ++n) expect((history = history.redo()).present).toBe(n);
    expect(history.redo()).toBe(history);
  });

  test("a new edit drops what was undone", () => {
    const history = History.of("a").edit("b", "").undo().edit("c", "");
    expect(history.redoes).toBeNull();
    expect(history.undo().present).toBe("a");
    expect(history.some((value) => value === "b")).toBe(false);
  });

  test("a gesture is one step, until it ends or another begins", () => {
    let history = History.of(0);
    for (const value of [1, 2, 3]) history = history.edit(value, "slider", "low");
    expect(history.undo().present).toBe(0);
    expect(history.undo().redo().present).toBe(3);
    history = history.edit(4, "slider", "high");
    expect(history.undo().present).toBe(3);
    history = history.close().edit(5, "slider", "high");
    expect(history.undo().present).toBe(4);
    // Undoing ends it: going on would lose the value that was undone to.
    history = history.undo().edit(6, "slider", "high");
    expect(history.undo().present).toBe(4);
  });
});
