import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import { numbers_from } from "../testing";
import { frame_of_jpeg } from "./jpeg";

const picture = new Uint8Array(readFileSync(new URL("../../mock/fixture/1.jpg", import.meta.url)));

function segment(marker: number, text: string): number[] {
  return [0xff, marker, (text.length + 2) >> 8, (text.length + 2) & 255, ...[...text].map((letter) => letter.charCodeAt(0))];
}
function with_segments(...segments: number[][]): Uint8Array {
  return Uint8Array.from([0xff, 0xd8, ...segments.flat(), ...picture.subarray(2)]);
}

test("finds the comment wherever it stands before the picture, and no other text", () => {
  for (const frame of [0, 7, 123456789]) {
    const comment = segment(0xfe, `frame ${frame}`);
    expect(frame_of_jpeg(with_segments(comment))).toBe(frame);
    expect(frame_of_jpeg(with_segments(segment(0xe1, "frame 5"), segment(0xfe, "made by hand"), comment))).toBe(frame);
  }
  for (const text of ["frame", "frame -1", "frame 1.5", "a frame 3", "frame 3 ", "frame 1234567890123456"]) {
    expect(frame_of_jpeg(with_segments(segment(0xfe, text))), text).toBeNull();
  }
  expect(frame_of_jpeg(picture)).toBeNull();
});

test("whatever is cut off or spoiled is no frame or the same one, and never an endless search", () => {
  const whole = with_segments(segment(0xfe, "frame 42"));
  for (let n = 0; n < 40; ++n) expect([null, 42]).toContain(frame_of_jpeg(whole.subarray(0, n)));
  const random = numbers_from(1, 0, 256);
  for (let i = 0; i < 2000; ++i) frame_of_jpeg(Uint8Array.from({ length: 64 }, (_, n) => (n < 2 ? [0xff, 0xd8][n]! : n % 3 === 0 ? 0xff : random())));
});
