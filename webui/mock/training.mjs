// Stands in for color training: the requests of public/openapi.yaml, with a table from mere histogram boxes. Not the training of the program, which is C++; only its shape.
import { frame_message } from "./frames.mjs";

const classes = ["no_color", "black", "white", "green", "blue", "cyan", "magenta", "red", "yellow"];
const priority = ["red", "yellow", "blue", "cyan", "magenta", "green", "white", "black"];

const option = (key, unit, low, high, usual, meaning, whole = false) => ({ key, unit, low, high, whole, meaning, default: usual, value: usual, changed: false });
const known_options = [
  option("outlier_share", "1", 0, 0.2, 0.002, "share of a class's pixels that may be wrong or freak"),
  option("brightness_outlier_share", "1", 0, 0.2, 0.02, "share of a class's pixels at either end of its brightness that is dropped"),
  option("closing_px", "step", 1, 31, 5, "side of the square that closes gaps between cells that were merely not drawn", true),
  option("opening_px", "step", 1, 15, 3, "side of the square that removes single cells", true),
  option("noise_margin", "step", 0, 20, 3, "margin around the cluster"),
];
/// So many frames can still be kept after they were shown.
const remembered_frames = 40;

class Refused extends Error {
  constructor(status, reason) {
    super(reason);
    this.status = status;
  }
}

function inside(x, y, polygon) {
  let odd = false;
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    const [ax, ay] = polygon[i], [bx, by] = polygon[j];
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) odd = !odd;
  }
  return odd;
}

function near(x, y, stroke, radius) {
  return stroke.some(([bx, by], i) => {
    const [ax, ay] = stroke[Math.max(i - 1, 0)];
    const [dx, dy] = [bx - ax, by - ay];
    const share = dx * dx + dy * dy === 0 ? 0 : Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0), 1);
    return (x - ax - share * dx) ** 2 + (y - ay - share * dy) ** 2 <= radius ** 2;
  });
}

/// Calls `use(y, u, v)` for the pixels of a sample.
function each_pixel(sample, bytes, use) {
  const width = bytes.readUInt32LE(4), height = bytes.readUInt32LE(8), chroma_width = Math.ceil(width / 2);
  const u0 = 32 + width * height, v0 = u0 + chroma_width * height;
  const points = sample.polygon ?? sample.stroke ?? [[sample.rectangle[0], sample.rectangle[1]], [sample.rectangle[2] - 1, sample.rectangle[3] - 1]];
  const margin = sample.radius ?? 0;
  const bound = (i, pick, add) => Math.round(pick(...points.map((p) => p[i])) + add);
  const holds = sample.polygon ? (x, y) => inside(x, y, sample.polygon) : sample.stroke ? (x, y) => near(x, y, sample.stroke, sample.radius) : () => true;
  for (let r = Math.max(bound(1, Math.min, -margin), 0); r <= Math.min(bound(1, Math.max, margin), height - 1); ++r) {
    for (let c = Math.max(bound(0, Math.min, -margin), 0); c <= Math.min(bound(0, Math.max, margin), width - 1); ++c) {
      if (!holds(c, r)) continue;
      const chroma = r * chroma_width + (c >> 1);
      use(bytes[32 + r * width + c], bytes[u0 + chroma], bytes[v0 + chroma]);
    }
  }
}

/// Cells within `reach` of one with `value`, in a square, have it too.
function spread(cells, reach, value) {
  let from = cells;
  for (const [stride, line] of [[1, 256], [256, 1]]) {
    const to = new Uint8Array(65536).fill(1 - value);
    for (let n = 0, begin = 0; n < 256; ++n, begin += line) {
      // The last place that `value` reaches, and then backwards the same.
      for (let i = 0, last = -1000; i < 256; ++i) {
        if (from[begin + i * stride] === value) last = i;
        if (i - last <= reach) to[begin + i * stride] = value;
      }
      for (let i = 255, last = 1000; i >= 0; --i) {
        if (from[begin + i * stride] === value) last = i;
        if (last - i <= reach) to[begin + i * stride] = value;
      }
    }
    from = to;
  }
  return from;
}

export class MockTraining {
  constructor() {
    this.version = 1;
    this.draft = { samples: [], options: {}, brightness: {} };
    this.images = [];
    this.pixels = new Map();
    this.recent = new Map();
    this.history = [];
    this.next_table = 1;
    this.judged = null;
    this.train();
    this.in_use = this.table;
    this.remember("as shipped", true);
    this.saved = JSON.stringify(this.draft);
  }

  frame(frame, t) {
    const bytes = frame_message(frame, t);
    this.recent.set(frame, bytes);
    this.newest = frame;
    if (this.recent.size > remembered_frames) this.recent.delete(this.recent.keys().next().value);
    return bytes;
  }

  value(key) {
    return this.draft.options[key] ?? known_options.find((o) => o.key === key).default;
  }

  train() {
    this.counts = Object.fromEntries(classes.map((name) => [name, { samples: 0, pixels: 0, cells: new Uint32Array(65536), y: new Uint32Array(256) }]));
    for (const sample of this.draft.samples) {
      const count = this.counts[sample.class];
      ++count.samples;
      if (sample.mask) continue;
      each_pixel(sample, this.pixels.get(sample.image), (y, u, v) => {
        ++count.pixels;
        ++count.cells[v * 256 + u];
        ++count.y[y];
      });
    }
    const chroma = new Uint8Array(65536);
    const brightness = {};
    classes.forEach((name, label) => {
      const count = this.counts[name];
      if (label === 0 || count.pixels === 0) return;
      const least = Math.max(1, this.value("outlier_share") * count.pixels / 20);
      const margin = Math.round(this.value("noise_margin"));
      const closing = this.value("closing_px") >> 1;
      let cells = new Uint8Array(65536);
      for (let i = 0; i < 65536; ++i) if (count.cells[i] >= least) cells[i] = 1;
      cells = spread(spread(cells, closing + margin, 1), closing, 0);
      for (let i = 0; i < 65536; ++i) if (cells[i] === 1) chroma[i] |= 1 << (label - 1);
      brightness[name] = this.draft.brightness[name] ?? this.trained_brightness(count);
    });
    this.table = { chroma, brightness, priority, range: "limited" };
  }

  trained_brightness({ y, pixels }) {
    const drop = this.value("brightness_outlier_share") * pixels;
    let [low, high, below, above] = [0, 255, 0, 0];
    while (low < 255 && (below += y[low]) <= drop) ++low;
    while (high > low && (above += y[high]) <= drop) --high;
    return [Math.max(low - 12, 0), Math.min(high + 12, 255)];
  }

  told_table(table) {
    return { ...table, chroma: Buffer.from(table.chroma).toString("base64") };
  }

  result(seen) {
    const count = this.counts[seen];
    let most = 0;
    for (const n of count?.cells ?? []) if (n > most) most = n;
    const density = Buffer.alloc(65536);
    for (let i = 0; most > 0 && i < 65536; ++i) {
      const n = count.cells[i];
      if (n > 0) density[i] = most < 2 ? 255 : 1 + Math.round((254 * Math.log(n)) / Math.log(most));
    }
    const told_seen = count && { class: seen, most, brightness: [...count.y], density: density.toString("base64") };
    return {
      version: this.version, table: this.told_table(this.table), seen: told_seen ?? null, warnings: this.warnings(),
      classes: classes.map((name) => ({ class: name, samples: this.counts[name].samples, pixels: this.counts[name].pixels })),
    };
  }

  warnings() {
    const warnings = [];
    for (let a = 1; a < classes.length; ++a) {
      for (let b = a + 1; b < classes.length; ++b) {
        const [first, second] = [this.table.brightness[classes[a]], this.table.brightness[classes[b]]];
        if (!first || !second || first[0] > second[1] || second[0] > first[1]) continue;
        const both = (1 << (a - 1)) | (1 << (b - 1));
        const shared = this.table.chroma.reduce((n, bits) => n + ((bits & both) === both ? 1 : 0), 0);
        if (shared > 0) warnings.push(`${classes[a]} and ${classes[b]} share ${shared} cells`);
      }
    }
    return warnings;
  }

  /// Feigned, from how much was drawn.
  quality_now() {
    const known = classes.slice(1).filter((name) => this.counts[name].pixels > 0);
    return Object.fromEntries(known.map((name) => {
      const { pixels, samples } = this.counts[name];
      const good = 1 - 1 / (10 + samples + pixels / 200);
      return [name, samples > 1 ? { precision: good, recall: good - 0.01, pixels: Math.round(pixels / 3) } : { precision: null, recall: null, pixels: 0 }];
    }));
  }

  remember(notes) {
    for (const entry of this.history) entry.in_use = false;
    this.history.unshift({ id: `t${this.next_table++}`, date: new Date().toISOString().replace(/\.\d+Z/, "Z"), notes, in_use: true, quality: this.quality_now(),
      table: this.table });
  }

  told() {
    return {
      version: this.version, is_saved: JSON.stringify(this.draft) === this.saved, range: "limited",
      files: { samples: "robot/samples.yaml", colors: "robot/colors.yaml", images: "robot/samples", refusal: "" },
      images: this.images, samples: this.draft.samples,
      options: known_options.map((o) => ({ ...o, value: this.value(o.key), changed: this.value(o.key) !== o.default })),
      brightness: this.draft.brightness, history: this.history.map(({ table, ...entry }) => entry),
    };
  }

  put({ version, samples, options, brightness }) {
    if (version !== this.version) throw new Refused(409, `the draft is of version ${this.version}, the request of ${version}: another browser was faster`);
    for (const [key, value] of Object.entries(options)) {
      const known = known_options.find((o) => o.key === key);
      if (!known) throw new Refused(400, `${key}: is no option`);
      if (value < known.low || value > known.high) throw new Refused(400, `${key}: is ${value}, must be ${known.low} .. ${known.high}`);
    }
    for (const { image } of samples) if (!this.pixels.has(image)) throw new Refused(400, `image: '${image}' is not there`);
    this.draft = { samples, options, brightness };
    ++this.version;
    this.changed_at = Date.now();
    this.train();
  }

  quality() {
    const is_running = Date.now() - (this.changed_at ?? 0) < 500;
    if (!is_running) this.judged = this.version;
    return { version: is_running ? this.judged : this.version, is_running, classes: this.quality_now() };
  }

  keep(frame) {
    const known = this.recent.has(frame) ? frame : this.newest;
    if (known === undefined) throw new Refused(503, "no frame has come yet");
    const bytes = this.recent.get(known);
    const id = `k${known}`;
    if (!this.pixels.has(id)) {
      this.pixels.set(id, bytes);
      this.images.push({ id, name: `frame ${known}`, width: bytes.readUInt32LE(4), height: bytes.readUInt32LE(8), kept: false });
    }
    return this.images.find((image) => image.id === id);
  }

  forget(id) {
    if (!this.pixels.has(id)) throw new Refused(404, `image: '${id}' is not there`);
    if (this.draft.samples.some((sample) => sample.image === id)) throw new Refused(409, `image: '${id}' has samples`);
    this.pixels.delete(id);
    this.images = this.images.filter((image) => image.id !== id);
  }

  save({ version, notes = "" }) {
    if (version !== this.version) throw new Refused(409, `the draft is of version ${this.version}, the request of ${version}`);
    this.images = this.images.map((image) => ({ ...image, kept: image.kept || this.draft.samples.some((sample) => sample.image === image.id) }));
    this.remember(notes);
    this.in_use = this.table;
    this.saved = JSON.stringify(this.draft);
  }

  restore(id) {
    const entry = this.history.find((e) => e.id === id);
    if (!entry) throw new Refused(404, `table: '${id}' is not there`);
    for (const other of this.history) other.in_use = other === entry;
    this.in_use = entry.table;
  }

  /// The answer to a request below /api/training: text, bytes, or null when there is no such request. Throws what has a status.
  answer(method, path, query, body) {
    const parsed = () => {
      try {
        return JSON.parse(body);
      } catch {
        throw new Refused(400, "the request is no JSON");
      }
    };
    const image = /^\/images\/([^/]+)$/.exec(path)?.[1];
    const seen = query.get("class");
    switch (`${method} ${image === undefined ? path : "/images/"}`) {
      case "GET ": return JSON.stringify(this.told());
      case "GET /table": return JSON.stringify(this.told_table(this.in_use));
      case "GET /quality": return JSON.stringify(this.quality());
      case "GET /result": return JSON.stringify(this.result(seen));
      case "PUT /draft": this.put(parsed()); return JSON.stringify(this.result(seen));
      case "POST /images": return JSON.stringify(this.keep(parsed().frame));
      case "GET /images/": {
        const bytes = this.pixels.get(decodeURIComponent(image));
        if (!bytes) throw new Refused(404, `image: '${image}' is not there`);
        return bytes;
      }
      case "DELETE /images/": this.forget(decodeURIComponent(image)); return JSON.stringify(this.told());
      case "POST /save": this.save(parsed()); return JSON.stringify(this.told());
      case "POST /restore": this.restore(parsed().id); return JSON.stringify(this.told());
      default: return null;
    }
  }
}
