/// A JPEG says which frame it shows in a comment, "frame 17"; nothing when it does not, or is none.
///
/// head    its first bytes; comments further on are not found
/// source  segments as in ITU-T T.81, B.1.1
export function frame_of_jpeg(head: Uint8Array): number | null {
  if (head[0] !== 0xff || head[1] !== 0xd8) return null;
  let at = 2;
  while (at + 4 <= head.length && head[at] === 0xff) {
    const marker = head[at + 1]!;
    const length = head[at + 2]! * 256 + head[at + 3]!;
    if (marker === 0xda || length < 2) return null;   // the picture itself begins
    if (marker === 0xfe && at + 2 + length <= head.length) {
      const text = String.fromCharCode(...head.subarray(at + 4, at + 2 + length));
      const match = /^frame (\d{1,15})$/.exec(text);
      if (match) return Number(match[1]);
    }
    at += 2 + length;
  }
  return null;
}
