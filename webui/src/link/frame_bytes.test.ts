import { describe, expect, test } from "vitest";
import { frame_bytes, numbers_from } from "../testing";
import { head_bytes, largest_side, parse_frame } from "./frame_bytes";

describe("frames", () => {
  test("what is written is read, for even and odd widths", () => {
    const random = numbers_from(1, 0, 256);
    for (const [width, height] of [[1, 1], [2, 1], [3, 2], [8, 5], [17, 4]] as const) {
      const chroma = Math.ceil(width / 2) * height;
      const fill = (length: number): Uint8Array => Uint8Array.from({ length }, random);
      const [y, u, v] = [fill(width * height), fill(chroma), fill(chroma)];
      const frame = parse_frame(frame_bytes({ width, height, range: "full", frame: 2 ** 40 + 7, t: 1.25, y, u, v }));
      expect(frame).toEqual({ width, height, range: "full", frame: 2 ** 40 + 7, t: 1.25, y, u, v });
    }
  });

  const good = (): ArrayBuffer =>
    frame_bytes({ width: 3, height: 2, range: "limited", frame: -1, t: 0, y: new Uint8Array(6), u: new Uint8Array(4), v: new Uint8Array(4) });

  test("every other length is refused", () => {
    expect(parse_frame(good()).frame).toBe(-1);
    const whole = good();
    for (let length = 0; length < whole.byteLength; ++length) expect(() => parse_frame(whole.slice(0, length)), String(length)).toThrow(/bytes/);
    const longer = new Uint8Array(whole.byteLength + 1);
    longer.set(new Uint8Array(whole));
    expect(() => parse_frame(longer.buffer)).toThrow(/bytes/);
    expect(head_bytes).toBe(32);
  });

  test("sizes and ranges that cannot be are refused before anything is made", () => {
    const with_u32 = (at: number, value: number): ArrayBuffer => {
      const bytes = good();
      new DataView(bytes).setUint32(at, value, true);
      return bytes;
    };
    for (const side of [0, largest_side + 1, 2 ** 31, 2 ** 32 - 1]) {
      expect(() => parse_frame(with_u32(4, side))).toThrow(/each side/);
      expect(() => parse_frame(with_u32(8, side))).toThrow(/each side/);
    }
    expect(() => parse_frame(with_u32(12, 2))).toThrow(/range/);
    expect(() => parse_frame(with_u32(0, 0x54595556))).toThrow(/TYUV/);   // the letters backwards
  });
});
