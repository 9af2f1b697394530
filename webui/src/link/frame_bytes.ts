/// A frame with the pixels as the vision classifies them. The pixel at column c, row r has Y y[r * width + c] and chroma at
/// r * ceil(width / 2) + floor(c / 2).
export interface YuvFrame {
  readonly width: number;
  readonly height: number;
  readonly range: "limited" | "full";
  /// As in scenes; -1 where there is none.
  readonly frame: number;
  /// [s]
  readonly t: number;
  readonly y: Uint8Array;
  readonly u: Uint8Array;
  readonly v: Uint8Array;
}

/// "TYUV", width, height, range, frame, t. [B]
export const head_bytes = 4 + 3 * 4 + 8 + 8;
/// No camera of a robot is wider or higher; a message that says so is none.
export const largest_side = 8192;

/// A message of /ws/frame, or a kept picture. Throws when it is none; `y`, `u` and `v` share its memory.
export function parse_frame(bytes: ArrayBuffer): YuvFrame {
  if (bytes.byteLength < head_bytes) throw new Error(`frame: has ${bytes.byteLength} bytes, its head alone needs ${head_bytes}`);
  const view = new DataView(bytes);
  if (view.getUint32(0, false) !== 0x54595556) throw new Error("frame: does not begin with TYUV");
  const [width, height, range] = [view.getUint32(4, true), view.getUint32(8, true), view.getUint32(12, true)];
  if (width < 1 || width > largest_side || height < 1 || height > largest_side) {
    throw new Error(`frame: is ${width} x ${height}, each side must be 1 .. ${largest_side}`);
  }
  if (range > 1) throw new Error(`frame: range is ${range}, must be 0 or 1`);
  const luma = width * height;
  const chroma = Math.ceil(width / 2) * height;
  const wanted = head_bytes + luma + 2 * chroma;
  if (bytes.byteLength !== wanted) throw new Error(`frame: has ${bytes.byteLength} bytes, its size needs ${wanted}`);
  return {
    width,
    height,
    range: range === 1 ? "full" : "limited",
    frame: Number(view.getBigInt64(16, true)),
    t: view.getFloat64(24, true),
    y: new Uint8Array(bytes, head_bytes, luma),
    u: new Uint8Array(bytes, head_bytes + luma, chroma),
    v: new Uint8Array(bytes, head_bytes + luma + chroma, chroma),
  };
}
