import { describe, expect, test } from "vitest";
import { empty_scene, numbers_from } from "../testing";
import { Live, SmoothedTimes } from "./live";

const text = (frame: number): string => JSON.stringify(empty_scene(frame));

describe("live", () => {
  test("the screen has the newest scene, whatever came in between", () => {
    const random = numbers_from(1, 0, 4);
    const live = new Live();
    let frame = -1;
    for (let now = 0; now < 5000; now += 16) {
      for (let n = Math.floor(random()); n > 0; --n) live.message(text(++frame), now);
      live.tick(now);
      if (frame >= 0) expect(live.drawn.value!.frame).toBe(frame);
    }
  });

  test("tables change less often, by a scene that was drawn, and end with the newest", () => {
    const live = new Live(150);
    const read: number[] = [];
    live.read.subscribe(() => read.push(live.read.value!.frame));
    for (let now = 0; now < 3000; now += 10) {
      live.message(text(now), now);
      live.tick(now);
    }
    expect(read.length).toBe(3000 / 150);
    live.tick(4000);
    expect(live.read.value).toBe(live.drawn.value);
  });

  test("frozen, tables and canvases show one scene, and nothing moves; going on shows the newest", () => {
    const live = new Live(150);
    for (const now of [0, 20, 40]) {
      live.message(text(now), now);
      live.tick(now);
    }
    live.freeze();
    expect(live.read.value!.frame).toBe(40);
    expect(live.drawn.value!.frame).toBe(40);
    for (const now of [60, 400, 900]) {
      live.message(text(now), now);
      live.tick(now);
    }
    expect([live.read.value!.frame, live.drawn.value!.frame]).toEqual([40, 40]);
    live.go_on();
    live.tick(920);
    expect([live.read.value!.frame, live.drawn.value!.frame]).toEqual([900, 900]);
  });

  test("frozen with a picture, it is the picture's scene, as long as that is known; else the one that was drawn", () => {
    for (const [picture, expected] of [[40, 40], [38, 38], [41, 41], [23, 23], [5, 40], [99, 40], [null, 40]] as const) {
      const live = new Live();
      for (let frame = 0; frame <= 40; ++frame) {
        live.message(text(frame), 10 * frame);
        live.tick(10 * frame);
      }
      live.message("no scene", 405);
      live.tick(405);
      if (picture === 41) live.message(text(41), 410);   // not yet drawn, but its picture was quick
      live.freeze(picture);
      live.message(text(50), 500);
      live.tick(500);
      expect([live.drawn.value!.frame, live.read.value!.frame]).toEqual([expected, expected]);
    }
  });

  test("silence is counted from the last message, also while frozen", () => {
    const live = new Live();
    expect(live.silence(5)).toBeNull();
    live.message(text(1), 10);
    live.freeze();
    live.message(text(2), 30);
    expect(live.silence(100)).toBe(70);
  });

  test("what is no scene leaves the one before", () => {
    const live = new Live(0);
    live.message(text(1), 0);
    live.tick(0);
    live.message("{\"frame\": 2", 10);
    live.tick(10);
    expect(live.drawn.value!.frame).toBe(1);
    expect(live.broken).toBe(1);
  });
});

describe("smoothed times", () => {
  test("a constant stays what it is; all others lie between the least and the greatest", () => {
    const random = numbers_from(2, 1, 3);
    const times = new SmoothedTimes();
    for (let now = 0; now < 3000; now += 30) {
      times.add({ constant: 2, noisy: random() }, now);
      const [constant, noisy] = times.times();
      expect(constant!.ms).toBeCloseTo(2, 12);
      expect(noisy!.ms).toBeGreaterThanOrEqual(1);
      expect(noisy!.ms).toBeLessThanOrEqual(3);
    }
  });

  test("a jump is followed by the same share after the same time, at any rate", () => {
    const after = (step: number): number => {
      const times = new SmoothedTimes(1000);
      times.add({ a: 0 }, 0);
      for (let now = step; now <= 1000; now += step) times.add({ a: 1 }, now);
      return times.times()[0]!.ms;
    };
    expect(after(10)).toBeCloseTo(1 - Math.exp(-1), 9);
    expect(after(100)).toBeCloseTo(after(10), 9);
    expect(after(1000)).toBeCloseTo(after(10), 9);
  });

  test("the order is the scene's, and what is gone is gone", () => {
    const times = new SmoothedTimes();
    times.add({ a: 1, b: 2 }, 0);
    times.add({ c: 1, b: 2 }, 10);
    expect(times.times().map(({ stage }) => stage)).toEqual(["c", "b"]);
  });
});
