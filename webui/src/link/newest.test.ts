import { expect, test } from "vitest";
import { numbers_from } from "../testing";
import { Newest, NewestDecoder } from "./newest";

test("only the newest is taken, once, and what was passed over is counted", () => {
  const random = numbers_from(1, 0, 1);
  const newest = new Newest<number>();
  let [put, taken, last] = [0, 0, 0];
  for (let i = 0; i < 1000; ++i) {
    if (random() < 0.6) newest.put(last = ++put);
    else {
      const value = newest.take();
      if (value === null) continue;
      ++taken;
      expect(value).toBe(last);
      expect(newest.take()).toBeNull();
    }
  }
  if (newest.take() !== null) ++taken;
  expect(taken + newest.dropped).toBe(put);
});

/// A decoder whose results come when the test says so.
function held() {
  const waiting: (() => void)[] = [];
  const done: number[] = [];
  const decoder = new NewestDecoder<number, number>(
    (value) => new Promise((resolve, reject) => waiting.push(() => (value < 0 ? reject(new Error("broken")) : resolve(value)))), (value) => done.push(value));
  const finish = async () => {
    waiting.shift()!();
    await new Promise((settled) => setTimeout(settled));
  };
  return { decoder, done, finish, waiting };
}

test("one value is decoded at a time, meanwhile only the newest waits, and order is kept", async () => {
  const { decoder, done, finish, waiting } = held();
  for (let value = 1; value <= 5; ++value) decoder.put(value);
  expect(waiting.length).toBe(1);
  await finish();
  expect(waiting.length).toBe(1);
  await finish();
  expect(done).toEqual([1, 5]);
  expect(decoder.dropped).toBe(3);
  decoder.put(6);
  await finish();
  expect(done).toEqual([1, 5, 6]);
});

test("a broken value is counted and stops nothing", async () => {
  const { decoder, done, finish } = held();
  decoder.put(-1);
  decoder.put(2);
  await finish();
  await finish();
  expect(done).toEqual([2]);
  expect(decoder.broken).toBe(1);
});
