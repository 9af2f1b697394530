// Stands in for calibration: the requests of public/openapi.yaml, a drawn target that is held here and there, and a made-up result. Not the detection and
// the solver of the program, which are C++; only their shape.
import { deflateSync } from "node:zlib";
import { height, width } from "./frames.mjs";

const head = 32;
const columns = 12, rows = 9;
const least_views = 3;
const solving_ms = 1500;
/// So many frames the target is held, and so many it moves to the next place.
const held_frames = 9, moving_frames = 7;
/// Views whose corners lie nearer than this, in the middle, are alike. [px]
const alike_px = 34;

class Refused extends Error {
  constructor(status, reason) {
    super(reason);
    this.status = status;
  }
}

const models = {
  division: [["fx", 412.36, 0.21], ["fy", 411.87, 0.2], ["cx", 322.4, 0.31], ["cy", 236.9, 0.28], ["k", -0.2143, 0.0009]],
  plumb_bob: [["fx", 412.9, 0.33], ["fy", 412.4, 0.32], ["cx", 322.1, 0.45], ["cy", 237.3, 0.4], ["k1", -0.2871, 0.0041], ["k2", 0.0823, 0.0102], ["p1", 0.00041, 0.00012],
    ["p2", -0.00022, 0.00013], ["k3", -0.0102, 0.0071]],
  equidistant: [["fx", 413.2, 0.29], ["fy", 412.7, 0.28], ["cx", 322.3, 0.4], ["cy", 237.1, 0.37], ["k1", -0.0312, 0.0022], ["k2", 0.0041, 0.0051], ["k3", -0.0012, 0.0046], ["k4", 0.0003, 0.0014]],
};

/// Throws what is wrong with a target's text.
function target_of(text) {
  const match = /^(?:(dots):(\d+)x(\d+):([\d.e-]+):([\d.e-]+)|(checker):(\d+)x(\d+):([\d.e-]+))$/.exec(text);
  if (match === null) throw new Refused(400, `target ${text}: must be dots:COLUMNSxROWS:PITCH:RADIUS or checker:COLUMNSxROWS:PITCH, with lengths in metres`);
  const dots = match[1] !== undefined;
  const [nx, ny, pitch] = (dots ? match.slice(2, 5) : match.slice(7, 10)).map(Number);
  const radius = dots ? Number(match[5]) : 0;
  for (const n of [nx, ny]) if (n < 3 || n > 64) throw new Refused(400, `target.columns: is ${n}, must be within 3 and 64`);
  if (!(pitch > 0 && pitch <= 1)) throw new Refused(400, `target.pitch: is ${pitch} m, must be at most 1; lengths are in metres`);
  if (dots && !(radius > 0 && radius < pitch / 2)) throw new Refused(400, `target.radius: is ${radius}, must be > 0 and < half the pitch, ${pitch / 2}`);
  return { dots, nx, ny, share: radius / pitch };
}

/// The same numbers each time.
function numbers_from(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/// Where the middle of the target is held, one place after another; every fifth is a look past it. x, y, distance in widths of the target, angles. [rad]
const places = (() => {
  const random = numbers_from(7);
  const spots = [[0.5, 0.5], [0.2, 0.25], [0.8, 0.25], [0.8, 0.72], [0.2, 0.72], [0.5, 0.2], [0.16, 0.5], [0.84, 0.5], [0.5, 0.8], [0.35, 0.4], [0.65, 0.6], [0.65, 0.35]];
  return spots.map(([x, y], i) => ({
    x: x * width, y: y * height, distance: i === 0 ? 1.5 : 1.9 + 1.1 * random(), roll: 0.8 * (random() - 0.5), pan: 1.3 * (random() - 0.5), tilt: 1.1 * (random() - 0.5), is_away: i % 5 === 4,
  }));
})();

function between(a, b, share) {
  const smooth = share * share * (3 - 2 * share);
  const mix = (key) => a[key] + (b[key] - a[key]) * smooth;
  return { x: mix("x"), y: mix("y"), distance: mix("distance"), roll: mix("roll"), pan: mix("pan"), tilt: mix("tilt"), is_away: a.is_away && b.is_away };
}

/// [px] of a place on the target, whose middle is (0, 0) and whose width is 1, as a matrix of three rows.
function homography({ x, y, distance, roll, pan, tilt }) {
  const focal = 412;
  const [cr, sr, cp, sp, ct, st] = [Math.cos(roll), Math.sin(roll), Math.cos(pan), Math.sin(pan), Math.cos(tilt), Math.sin(tilt)];
  // Columns of the rotation for the target's axes, then where its middle is.
  const [ax, ay, az] = [cp * cr, ct * sr + st * sp * cr, st * sr - ct * sp * cr];
  const [bx, by, bz] = [-cp * sr, ct * cr - st * sp * sr, st * cr + ct * sp * sr];
  return [
    [focal * ax + x * az, focal * bx + x * bz, x * distance],
    [focal * ay + y * az, focal * by + y * bz, y * distance],
    [az, bz, distance],
  ];
}

function project(h, x, y) {
  const w = h[2][0] * x + h[2][1] * y + h[2][2];
  return [(h[0][0] * x + h[0][1] * y + h[0][2]) / w, (h[1][0] * x + h[1][1] * y + h[1][2]) / w];
}

function inverse([[a, b, c], [d, e, f], [g, h, i]]) {
  return [[e * i - f * h, c * h - b * i, b * f - c * e], [f * g - d * i, a * i - c * g, c * d - a * f], [d * h - e * g, b * g - a * h, a * e - b * d]];
}

function png(pixels) {
  const chunk = (name, data) => {
    const bytes = Buffer.alloc(12 + data.length);
    bytes.writeUInt32BE(data.length, 0);
    bytes.write(name, 4, "latin1");
    data.copy(bytes, 8);
    let crc = 0xffffffff;
    for (const byte of bytes.subarray(4, 8 + data.length)) {
      crc ^= byte;
      for (let k = 0; k < 8; ++k) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
    }
    bytes.writeUInt32BE((crc ^ 0xffffffff) >>> 0, 8 + data.length);
    return bytes;
  };
  const header = Buffer.from([0, 0, 0, 0, 0, 0, 0, 0, 8, 2, 0, 0, 0]);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  const lines = Buffer.alloc(height * (1 + 3 * width));
  for (let r = 0; r < height; ++r) pixels.copy(lines, r * (1 + 3 * width) + 1, r * 3 * width, (r + 1) * 3 * width);
  return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]), chunk("IHDR", header), chunk("IDAT", deflateSync(lines, { level: 1 })), chunk("IEND", Buffer.alloc(0))]);
}

export class MockCalibration {
  is_on = false;
  is_automatic = true;
  targets = ["dots:7x7:0.04:0.01"];
  model = "division";
  now = null;
  views = [];
  result = null;
  failure = "";
  is_saved = false;
  count = 0;
  solving = null;
  captures = [];

  /// The frame with the target in it; looked at, while it is on.
  frame(bytes, frame) {
    if (!this.is_on) return bytes;
    const step = Math.floor(frame / (held_frames + moving_frames)), at = frame % (held_frames + moving_frames);
    const [here, next] = [places[step % places.length], places[(step + 1) % places.length]];
    const moves = at >= held_frames;
    const place = between(here, next, moves ? (at - held_frames) / moving_frames : 0);
    const drawn = place.is_away ? bytes : this.draw(Buffer.from(bytes), place);
    this.look(frame, place, moves);
    return drawn;
  }

  draw(bytes, place) {
    const { dots, nx, ny, share } = target_of(this.targets[0]);
    const pitch = 1 / (nx + 1.5);
    const margin = dots ? 1.6 : 1.8;
    const h = homography(place), back = inverse(h);
    const [half_x, half_y] = [((nx - 1) / 2 + margin) * pitch, ((ny - 1) / 2 + margin) * pitch];
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => project(h, x * half_x, y * half_y));
    const bound = (i, pick, low, high) => Math.min(Math.max(Math.round(pick(...corners.map((corner) => corner[i]))), low), high);
    const chroma_width = width / 2, u0 = head + width * height, v0 = u0 + chroma_width * height;
    for (let r = bound(1, Math.min, 0, height); r < bound(1, Math.max, 0, height); ++r) {
      for (let c = bound(0, Math.min, 0, width); c < bound(0, Math.max, 0, width); ++c) {
        const [x, y] = project(back, c, r);
        if (Math.abs(x) > half_x || Math.abs(y) > half_y) continue;
        // In pitches from the first point.
        const [i, j] = [x / pitch + (nx - 1) / 2, y / pitch + (ny - 1) / 2];
        const out = Math.max(-i, i - nx + 1, -j, j - ny + 1);
        const black = dots ? (out < 0.5 ? Math.hypot(i - Math.round(i), j - Math.round(j)) < share : out > 1 && out < 1.25)
          : out < 1 && (Math.floor(i) + Math.floor(j)) % 2 === 0;
        bytes[head + r * width + c] = black ? 34 : 208;
        bytes[u0 + r * chroma_width + (c >> 1)] = bytes[v0 + r * chroma_width + (c >> 1)] = 128;
      }
    }
    return bytes;
  }

  look(frame, place, moves) {
    const { nx, ny } = target_of(this.targets[0]);
    const pitch = 1 / (nx + 1.5), h = homography(place);
    const points = Array.from({ length: nx * ny }, (_, n) => project(h, ((n % nx) - (nx - 1) / 2) * pitch, (Math.floor(n / nx) - (ny - 1) / 2) * pitch));
    const is_inside = points.every(([x, y]) => x >= 0 && y >= 0 && x < width && y < height);
    const found = !place.is_away && is_inside;
    const asked = found ? this.captures.splice(0) : [];
    const alike = this.views.find((view) => this.distance(view.points, points) < alike_px);
    let verdict = `no target found: no ${this.targets[0]}: no place in the image looks like it`, captured = false;
    if (found) {
      verdict = moves ? "moves: 31 px since the last look" : alike !== undefined ? `like view ${alike.id}` : "new: at rest, and like no other view";
      captured = asked.length > 0 || (!moves && alike === undefined && this.is_automatic);
    }
    if (captured) {
      this.drop();
      this.views.push({ id: String(++this.count), frame, target: this.targets[0], points, rms_px: null, rejected: "" });
      verdict = `captured as view ${this.count}`;
    }
    this.now = { frame, target: found ? this.targets[0] : null, points: found ? points : [], verdict, is_captured: captured };
    for (const answer of asked) answer();
  }

  distance(a, b) {
    const ends = (points) => [points[0], points.at(-1)];
    return a.length !== b.length ? Infinity : ends(a).reduce((sum, [x, y], i) => sum + Math.hypot(x - ends(b)[i][0], y - ends(b)[i][1]) / 2, 0);
  }

  coverage() {
    const points = new Array(columns * rows).fill(0);
    for (const view of this.views) {
      for (const [x, y] of view.points) ++points[Math.floor((y / height) * rows) * columns + Math.floor((x / width) * columns)];
    }
    return { columns, rows, points, share: points.filter((n) => n > 0).length / points.length };
  }

  drop() {
    this.result = null;
    this.is_saved = false;
    for (const view of this.views) Object.assign(view, { rms_px: null, rejected: "" });
  }

  solve() {
    this.is_automatic = false;
    if (this.solving !== null) throw new Refused(409, "the camera is being worked out");
    if (this.views.length === 0) throw new Refused(409, "there are no views");
    this.failure = "";
    this.solving = setTimeout(() => {
      this.solving = null;
      this.finish();
    }, solving_ms);
  }

  finish() {
    this.drop();
    if (this.views.length < least_views) {
      this.failure = `views: are ${this.views.length}, must be at least ${least_views}`;
      return;
    }
    const random = numbers_from(this.count);
    for (const [i, view] of this.views.entries()) {
      view.rms_px = i === 3 ? 0.71 : 0.1 + 0.08 * random();
      view.rejected = i === 3 ? "its points lie 4.8 times as far off as those of the middle view" : "";
    }
    const used = this.views.filter(({ rejected }) => rejected === "").length;
    const { share } = this.coverage();
    this.result = {
      model: this.model, views: used, rms_px: 0.142, cross_validated_rms_px: used < 5 ? null : 0.151 + 0.3 / used, worst_sigma_px: used < 4 ? null : 2.4 / used,
      values: models[this.model].map(([name, value, sigma]) => ({ name, value, sigma: sigma * Math.sqrt(10 / used) })),
      warnings: share < 0.75 ? [`only ${Math.round(100 * share)} % of the image have points; beyond them the lens is extrapolated`] : [],
    };
  }

  residuals() {
    if (this.result === null) throw new Refused(404, "there is no result");
    const pixels = Buffer.alloc(3 * width * height, 250);
    const random = numbers_from(3);
    const dot = (x, y, color) => {
      const [c, r] = [Math.round(x), Math.round(y)];
      if (c >= 0 && r >= 0 && c < width && r < height) pixels.set(color, 3 * (r * width + c));
    };
    for (const { points, rejected } of this.views) {
      for (const [x, y] of points) {
        const [dx, dy] = [24 * (random() - 0.5), 24 * (random() - 0.5)];
        for (let n = 0; n <= 24; ++n) dot(x + (dx * n) / 24, y + (dy * n) / 24, rejected === "" ? [30, 90, 160] : [200, 60, 60]);
        for (const [i, j] of [[0, 0], [1, 0], [0, 1], [1, 1]]) dot(x + i, y + j, [20, 20, 20]);
      }
    }
    return png(pixels);
  }

  told() {
    return JSON.stringify({
      is_on: this.is_on, is_automatic: this.is_automatic, is_solving: this.solving !== null, targets: this.targets, model: this.model, width, height, now: this.now, views: this.views,
      coverage: this.coverage(), result: this.result, failure: this.failure, file: { camera: "config/camera.yaml", refusal: "", is_saved: this.is_saved },
    });
  }

  change(asked) {
    if (asked.targets !== undefined) {
      if (!Array.isArray(asked.targets) || asked.targets.length < 1 || asked.targets.length > 4) throw new Refused(400, "targets: must be 1 to 4");
      asked.targets.forEach(target_of);
    }
    if (asked.model !== undefined && models[asked.model] === undefined) throw new Refused(400, `model: is '${asked.model}', must be one of ${Object.keys(models).join(", ")}`);
    if (asked.model !== undefined && asked.model !== this.model) this.drop();
    for (const key of ["targets", "model", "is_automatic", "is_on"]) if (asked[key] !== undefined) this[key] = asked[key];
    if (!this.is_on) this.now = null;
  }

  /// The next frame that shows it.
  async capture() {
    if (!this.is_on) throw new Refused(409, "calibration: is not on");
    await new Promise((done, fail) => {
      const late = setTimeout(() => {
        this.captures.splice(this.captures.indexOf(answer), 1);
        fail(new Refused(409, "view: was not captured: no target found"));
      }, 1500);
      const answer = () => {
        clearTimeout(late);
        done();
      };
      this.captures.push(answer);
    });
  }

  /// Null: there is no such request.
  async answer(method, rest, body) {
    const id = /^\/views\/([^/]+)$/.exec(rest)?.[1];
    if (method === "PUT" && rest === "") {
      let asked;
      try {
        asked = JSON.parse(body);
      } catch {
        throw new Refused(400, "the request is no JSON");
      }
      this.change(asked);
    } else if (method === "POST" && rest === "/views") await this.capture();
    else if (method === "DELETE" && rest === "/views") {
      this.views = [];
      this.drop();
    } else if (method === "DELETE" && id !== undefined) {
      if (!this.views.some((view) => view.id === id)) throw new Refused(404, `view ${id}: is not there`);
      this.views = this.views.filter((view) => view.id !== id);
      this.drop();
    } else if (method === "POST" && rest === "/solve") this.solve();
    else if (method === "GET" && rest === "/residuals") return this.residuals();
    else if (method === "POST" && rest === "/save") {
      if (this.result === null) throw new Refused(409, "there is no result");
      this.is_saved = true;
    } else if (method !== "GET" || rest !== "") return null;
    return this.told();
  }
}
