import { expect, test } from "vitest";
import { numbers_from } from "../testing";
import { fields_of, first_target, in_millimeters, text_of, type TargetFields, why_no_target } from "./target";

test("texts of targets become fields and the same text again", () => {
  const random = numbers_from(1, 0, 1);
  for (let n = 0; n < 500; ++n) {
    const [columns, rows] = [3 + Math.floor(60 * random()), 3 + Math.floor(60 * random())];
    const pitch = Number((0.001 + random() * 0.9).toPrecision(1 + Math.floor(6 * random())));
    const radius = Number((pitch * (0.05 + 0.4 * random())).toPrecision(3));
    const text = n % 2 === 0 ? `dots:${columns}x${rows}:${pitch}:${radius}` : `checker:${columns}x${rows + ((columns + rows + 1) % 2)}:${pitch}`;
    expect(why_no_target(fields_of(text)), text).toBe("");
    expect(text_of(fields_of(text))).toBe(text);
  }
});

test("the same target has the same text, however it was typed", () => {
  expect(text_of({ kind: "dots", columns: " 07", rows: "7 ", pitch: "0,0400", radius: ".01", spacing: "" })).toBe("dots:7x7:0.04:0.01");
  expect(text_of(fields_of("aprilgrid:6x6:0.025:0.3"))).toBe("aprilgrid:6x6:0.025:0.3");
  expect(why_no_target(fields_of("aprilgrid:6x6:0.025:0.3"))).toBe("");
  expect(why_no_target(fields_of("aprilgrid:6x1:0.025:0.3"))).toMatch(/^rows: is 1, must be 2 to 32/);
  expect(why_no_target(fields_of("aprilgrid:32x32:0.025:0.3"))).toMatch(/1024 tags/);
  expect(why_no_target(fields_of("aprilgrid:6x6:0.025:3"))).toMatch(/^spacing: is '3'/);
  expect(text_of({ kind: "checker", columns: "9", rows: "6", pitch: "25e-3", radius: "left over", spacing: "" })).toBe("checker:9x6:0.025");
});

test("what is no target names the field, what it is and what it must be", () => {
  const why = (part: Partial<TargetFields>): string => why_no_target({ ...first_target, ...part });
  expect(why({})).toBe("");
  for (const [part, reason] of [
    [{ columns: "" }, /^columns: is ''.*whole/], [{ columns: "2" }, /^columns: is 2, must be 3 to 64/], [{ rows: "65" }, /^rows: is 65/], [{ rows: "7.5" }, /^rows/],
    [{ pitch: "x" }, /^pitch: is 'x'/], [{ pitch: "0" }, /above 0/], [{ pitch: "-1" }, /above 0/], [{ pitch: "40" }, /lengths are in meters/],
    [{ radius: "" }, /^radius/], [{ radius: "0.0125" }, /half the pitch, 0.0125/], [{ kind: "checker", columns: "8", rows: "6" }, /turned around/],
  ] as const) expect(why(part), JSON.stringify(part)).toMatch(reason);
  expect(why({ kind: "checker", columns: "9", rows: "6", radius: "" })).toBe("");
});

test("what is no text of a target is no target either", () => {
  for (const text of ["", "dots", "dots:7:0.04:0.01", "dots:7x7", "checker:x6:0.04", "::::"]) expect(why_no_target(fields_of(text)), text).not.toBe("");
});

test("lengths are told in millimeters, too", () => {
  expect(["0.04", "0,00625", "x", "1"].map(in_millimeters)).toEqual(["40 mm", "6.25 mm", "", "1000 mm"]);
});
