import { describe, expect, test } from "vitest";
import { numbers_from } from "../testing";
import { advanced, age_words, clock_words, duration_words, file_words, first_moment, live, type Mode, type Moment, next_speed, sought, type Span, speeds, stepped, toggled, with_speed } from "./moment";

const span: Span = { begin: 100, end: 160 };
const at = (t: number, playing = false, speed = 1): Moment => ({ is_live: false, playing, t, speed });

test("a game is looked at as it is, a log waits at its beginning", () => {
  expect(first_moment("live", span)).toEqual({ is_live: true, playing: true, t: 160, speed: 1 });
  expect(first_moment("log", span)).toEqual({ is_live: false, playing: false, t: 100, speed: 1 });
});

test("whatever is done, the moment stays in what can be looked at, and live is its end", () => {
  for (let seed = 0; seed < 200; ++seed) {
    const random = numbers_from(seed, 0, 1);
    const mode: Mode = seed % 2 === 0 ? "live" : "log";
    let s = span;
    let moment = first_moment(mode, s);
    for (let i = 0; i < 40; ++i) {
      if (mode === "live") s = { begin: s.begin + random(), end: s.end + random() };   // time goes on
      const acts: ((m: Moment) => Moment)[] = [
        (m) => sought(m, s, 80 + 120 * random()), (m) => stepped(m, s, 4 * random() - 2), (m) => toggled(m, s), (m) => with_speed(m, 20 * random()),
        ...(mode === "live" ? [(m: Moment) => live(m, s)] : []),
      ];
      moment = advanced(acts[Math.floor(random() * acts.length)]!(moment), mode, s, random());
      expect(moment.t, `seed ${seed}`).toBeGreaterThanOrEqual(s.begin);
      expect(moment.t, `seed ${seed}`).toBeLessThanOrEqual(s.end);
      if (moment.is_live) expect(moment.t).toBe(s.end);
      if (mode === "log") expect(moment.is_live).toBe(false);
      expect(moment.speed).toBeGreaterThanOrEqual(0.1);
      expect(moment.speed).toBeLessThanOrEqual(10);
    }
  }
});

describe("playing", () => {
  test("is as fast as its speed", () => {
    for (const speed of speeds) expect(advanced(at(110, true, speed), "live", span, 2).t).toBeCloseTo(110 + 2 * speed);
  });
  test("up to now is live; a log ends, and begins anew when it is played again", () => {
    expect(advanced(at(159, true, 10), "live", span, 1).is_live).toBe(true);
    const ended = advanced(at(159, true, 10), "log", span, 1);
    expect(ended).toEqual(at(160, false, 10));
    expect(toggled(ended, span)).toEqual(at(100, true, 10));
  });
  test("paused, the same moment is the same value: nothing is drawn anew", () => {
    const paused = at(130);
    expect(advanced(paused, "live", span, 1)).toBe(paused);
  });
  test("what is forgotten is not shown any more", () => {
    expect(advanced(at(100), "live", { begin: 104, end: 164 }, 1).t).toBe(104);
  });
});

test("pausing live looks at what was shown; looking for a time pauses live, but goes on playing the past", () => {
  const now: Moment = { is_live: true, playing: true, t: 159.9, speed: 1 };
  expect(toggled(now, span)).toEqual(at(159.9));
  expect(sought(now, span, 120)).toEqual(at(120));
  expect(sought(at(110, true, 2), span, 120)).toEqual(at(120, true, 2));
  expect(stepped(at(110, true), span, 0.1).playing).toBe(false);
});

test("speeds go up and down one by one, and end", () => {
  let speed = 0.1;
  const up: number[] = [speed];
  for (let i = 0; i < 10; ++i) up.push(speed = next_speed(speed, true));
  expect([...new Set(up)]).toEqual([...speeds]);
  expect(next_speed(0.1, false)).toBe(0.1);
  expect(next_speed(10, true)).toBe(10);
});

test("durations are short and never claim 60 s of a minute", () => {
  expect([0, 0.04, 2.34, 9.949, 9.96, 59.6, 99.4, 99.6, 119.6, 3599.7, 3725].map(duration_words)).toEqual(
    ["0.0 s", "0.0 s", "2.3 s", "9.9 s", "10 s", "60 s", "99 s", "1:40 min", "2:00 min", "1:00 h", "1:02 h"]);
  for (let s = 0; s < 8000; s += 0.37) expect(duration_words(s)).not.toMatch(/:60/);
});

test("times are local; those of a log without dates count from its clock's beginning", () => {
  const t = new Date(2026, 10, 28, 7, 5, 9, 250).getTime() / 1000;
  expect(clock_words(t)).toBe("07:05:09.2");
  expect(file_words(t)).toBe("2026-11-28_07-05-09.250");
  expect(clock_words(75.3)).toBe("1:15.3");
  expect(file_words(75.25)).toBe("t75.250");
});

test("ages say what they are of", () => {
  const now: Moment = { is_live: true, playing: true, t: 160, speed: 1 };
  expect(age_words(now, "live", span)).toBe("now");
  expect(age_words(now, "live", span, 12)).toBe("12 s ago");
  expect(age_words(at(155), "live", span, 0)).toBe("5.0 s ago");
  expect(age_words(at(130), "log", span)).toBe("30 s of 60 s");
});
