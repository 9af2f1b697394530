// A drawn field as frames of /ws/frame: carpet, lines, a ball that rolls, two goals, a black robot with markers. 640x480, limited range.
export const width = 640, height = 480;
const chroma_width = width / 2;
const head = 32;

const yuv = {
  carpet: [88, 106, 100], line: [205, 128, 127], red: [112, 92, 196], yellow: [172, 48, 146], blue: [70, 170, 104],
  black: [32, 128, 128], cyan: [150, 160, 70], magenta: [110, 168, 190], hall: [120, 132, 130],
};

/// The same numbers each time.
function numbers_from(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

function draw(phase) {
  const name = new Array(width * height);
  const fill = (color, x0, y0, x1, y1) => {
    for (let r = Math.max(y0, 0); r < Math.min(y1, height); ++r) name.fill(color, r * width + Math.max(x0, 0), r * width + Math.min(x1, width));
  };
  const disc = (color, x, y, radius) => {
    for (let r = Math.ceil(y - radius); r <= y + radius; ++r) {
      const half = Math.sqrt(Math.max(radius ** 2 - (r - y) ** 2, 0));
      fill(color, Math.round(x - half), r, Math.round(x + half), r + 1);
    }
  };
  fill("hall", 0, 0, width, 120);
  fill("line", 0, 120, width, 170);
  fill("carpet", 0, 170, width, height);
  fill("yellow", 60, 90, 230, 168);
  fill("blue", 420, 96, 570, 168);
  fill("line", 0, 300, width, 308);
  fill("black", 300, 130, 390, 250);
  fill("cyan", 310, 140, 340, 160);
  fill("magenta", 350, 140, 380, 160);
  disc("red", 120 + 380 * (0.5 - 0.5 * Math.cos(2 * Math.PI * phase)), 370, 26);
  disc("red", 520, 220, 6);
  return name;
}

/// A message without its frame and time.
function message(phase, seed) {
  const bytes = Buffer.alloc(head + width * height + 2 * chroma_width * height);
  bytes.write("TYUV", 0, "latin1");
  bytes.writeUInt32LE(width, 4);
  bytes.writeUInt32LE(height, 8);
  const random = numbers_from(seed);
  const noise = (sigma) => sigma * (random() + random() + random() - 1.5) * 2;
  const name = draw(phase);
  const u0 = head + width * height, v0 = u0 + chroma_width * height;
  for (let r = 0; r < height; ++r) {
    const shade = 0.75 + (0.35 * r) / height;   // darker at the far end
    for (let c = 0; c < width; ++c) {
      const at = r * width + c;
      const [y, u, v] = yuv[name[at]];
      bytes[head + at] = Math.min(Math.max(16 + (y - 16) * shade + noise(4), 16), 235);
      if (c % 2 === 1) continue;
      const [, u2, v2] = yuv[name[at + 1]];
      const chroma = r * chroma_width + c / 2;
      bytes[u0 + chroma] = 128 + ((u + u2) / 2 - 128) * shade + noise(2);
      bytes[v0 + chroma] = 128 + ((v + v2) / 2 - 128) * shade + noise(2);
    }
  }
  return bytes;
}

const count = 16;
const frames = Array.from({ length: count }, (_, i) => message(i / count, 1 + i));

/// A message of its own, with its frame and time.
export function frame_message(frame, t) {
  const bytes = Buffer.from(frames[frame % count]);
  bytes.writeBigInt64LE(BigInt(frame), 16);
  bytes.writeDoubleLE(t, 24);
  return bytes;
}
