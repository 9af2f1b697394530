import { expect, test } from "vitest";
import { condition_of, type Signs, silence_limit_ms } from "./condition";

const well: Signs = { scene: { kind: "open" }, frozen: false, ended: false, trouble: "", silence_ms: 20, now: 1000 };

test("live is only said when scenes come and nothing else is to be said", () => {
  const alternatives: { [K in keyof Signs]: Signs[K][] } = {
    scene: [{ kind: "open" }, { kind: "connecting" }, { kind: "waiting", until: 2500 }, { kind: "closed" }],
    frozen: [false, true], ended: [false, true], trouble: ["", "not admitted: no token"], silence_ms: [20, null, silence_limit_ms + 1], now: [1000],
  };
  const all = (Object.keys(alternatives) as (keyof Signs)[]).reduce<Signs[]>(
    (some, key) => some.flatMap((signs) => alternatives[key].map((value) => ({ ...signs, [key]: value }) as Signs)), [well]);
  for (const signs of all) {
    const fine = signs.scene.kind === "open" && !signs.frozen && !signs.ended && signs.trouble === "" && signs.silence_ms === 20;
    expect(condition_of(signs).tone === "good", JSON.stringify(signs)).toBe(fine);
    expect(condition_of(signs).text === "live").toBe(fine);
    // Numbers of before must not look like numbers of now, frozen or not.
    if (signs.scene.kind !== "open" && signs.silence_ms !== null) expect(condition_of(signs).tone).toBe("bad");
  }
});

test("says when it is tried again, in whole seconds that never go below 0", () => {
  expect(condition_of({ ...well, scene: { kind: "waiting", until: 2500 } }).text).toBe("connection lost, next try in 2 s");
  expect(condition_of({ ...well, scene: { kind: "waiting", until: 900 } }).text).toBe("connection lost, next try in 0 s");
});
