import { expect, test } from "vitest";
import { numbers_from } from "../testing";
import { result_of, table_of, type ToldResult, type ToldTable } from "./training_api";

const base64 = (bytes: Uint8Array): string => Buffer.from(bytes).toString("base64");
const random = numbers_from(1, 0, 256);
const chroma = Uint8Array.from({ length: 65536 }, random);
const told: ToldTable = { chroma: base64(chroma), brightness: { green: [20, 90] }, priority: ["green", "black"], range: "full" };
const result: ToldResult = {
  version: 3, table: told, classes: [], warnings: [],
  seen: { class: "green", density: base64(chroma), most: 7, brightness: new Array<number>(256).fill(1) },
};

test("a table is read byte by byte", () => {
  expect(table_of(told)).toEqual({ ...told, chroma });
  expect(result_of(result).seen?.density).toEqual(chroma);
  expect(result_of({ ...result, seen: null }).seen).toBeNull();
});

test("a table that is none is refused, with what is wrong", () => {
  expect(() => table_of({ ...told, chroma: base64(chroma.subarray(1)) })).toThrow(/65535 bytes/);
  expect(() => table_of({ ...told, chroma: "not base64!" })).toThrow(/base64/);
  expect(() => table_of({ ...told, chroma: 5 as unknown as string })).toThrow(/no text/);
  expect(() => table_of({ ...told, priority: ["orange" as "red"] })).toThrow(/orange/);
  expect(() => result_of({ ...result, seen: { ...result.seen!, brightness: [1, 2] } })).toThrow(/256/);
});
