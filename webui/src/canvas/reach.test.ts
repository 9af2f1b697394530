import { expect, test } from "vitest";
import { empty_scene, numbers_from } from "../testing";
import { AutomaticReach, furthest, reaches } from "./reach";

const largest = reaches[reaches.length - 1]!;

test("what is needed fits at once, as far as there are reaches", () => {
  const random = numbers_from(1, 0, 25);
  const reach = new AutomaticReach();
  for (let now = 0; now < 100000; now += 50) {
    const needed = random();
    expect(reach.next(needed, now)).toBeGreaterThanOrEqual(Math.min(needed, largest));
  }
});

test("it shrinks only after less has been enough all the time", () => {
  const reach = new AutomaticReach(4, 3000);
  expect(reach.next(7, 0)).toBe(8);
  expect(reach.next(1, 1000)).toBe(8);
  expect(reach.next(7, 3500)).toBe(8);   // needed again: patience begins anew
  expect(reach.next(1, 4000)).toBe(8);
  expect(reach.next(1, 6900)).toBe(8);
  expect(reach.next(1, 7000)).toBe(2);
});

test("nothing needs no reach; the furthest of all kinds counts", () => {
  expect(furthest(empty_scene())).toBe(0);
  const unknown = { x: null, y: null, distance: null, bearing: null, near: null, far: null, cov: null };
  const ball = { ...unknown, box: [0, 0, 1, 1], center: [0, 0] as [number, number], radius_px: 1, confidence: 1 };
  expect(furthest({ ...empty_scene(), balls: [ball] })).toBe(0);
  expect(furthest({ ...empty_scene(), balls: [ball, { ...ball, x: 3, y: -4 }] })).toBe(5);
  const posts = [{ side: "left" as const, x: 0, y: 6 }];
  expect(furthest({ ...empty_scene(), goals: [{ color: "blue", box: [], bearing: 0, x: null, y: null, posts }] })).toBe(6);
  const free_space = { origin: [0, 0] as [number, number], angle_min: 0, angle_increment: 1, ranges: [7, null], state: ["free" as const, "unseen" as const] };
  expect(furthest({ ...empty_scene(), free_space })).toBe(7);
});
