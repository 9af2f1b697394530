// Stands in for `tassilo serve`: the same requests and channels, from a few recorded scenes. For work on the pages without a build.
// usage: node mock/server.mjs [--port N] [--pages DIR] [--rate HZ]
// Prints its address as the first line, like the server does. Only node's own modules and ws.
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { readFile, stat } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { WebSocketServer } from "ws";
import { MockCalibration } from "./calibration.mjs";
import { MockTraining } from "./training.mjs";

const here = path.dirname(fileURLToPath(import.meta.url));
const { values: options } = parseArgs({
  options: { port: { type: "string", default: "8081" }, pages: { type: "string", default: "" }, rate: { type: "string", default: "20" } },
});
const rate_hz = Number(options.rate);

const fixture = (name) => path.join(here, "fixture", name);
const scenes = readFileSync(fixture("scenes.jsonl"), "utf8").trim().split("\n").map((line) => JSON.parse(line));
const pictures = scenes.map((_, i) => readFileSync(fixture(`${i + 1}.jpg`)));
const stages = JSON.parse(readFileSync(fixture("stages.json"), "utf8"));
// Like a robot file that sets one option and leaves the rest: "back to the robot file" is not "back to the default".
const robot_file = { ball_max: 3 };

const options_of = (stage) => [...stage.options, ...stage.alternatives.flatMap((alternative) => alternative.options)];
const every_option = new Map(stages.flatMap(options_of).map((option) => [option.key, option]));
const filed = (option) => robot_file[option.key] ?? option.default;
for (const option of every_option.values()) option.value = filed(option);

const training = new MockTraining();
const calibration = new MockCalibration();
const state = { frame: 0, taken_over: 0, sent: 0, dropped: 0 };

const recording = { on: false, finishing: false, folder: "/home/robot/recordings", name: "", parts: 0, seconds: 0, frames: 0, bytes: 0, dropped: 0, trouble: "" };
let recording_since = 0;

/// As if it were on the disk at once.
function recording_now() {
  if (recording.on) recording.seconds = (Date.now() - recording_since) / 1000;
  return recording;
}

function record(on) {
  if (on && !recording.on) {
    recording_since = Date.now();
    const name = new Date().toISOString().slice(0, 19).replaceAll(":", "-") + "Z";
    Object.assign(recording, { name, parts: 1, frames: 0, bytes: 0, seconds: 0, trouble: "" });
  }
  recording_now();
  recording.on = on;
}

/// Why a change cannot be made; empty when it can.
function refusal(key, value) {
  const stage = stages.find((s) => s.key === key && s.alternatives.length > 0);
  if (stage) {
    const names = stage.alternatives.map((alternative) => alternative.name);
    return value === null || names.includes(value) ? "" : `${key}: is '${value}', must be one of ${names.join(", ")}`;
  }
  const option = every_option.get(key);
  if (!option) return `${key}: is no stage with alternatives and no option`;
  if (value === null) return "";
  if (typeof value !== "number" || !Number.isFinite(value)) return `${key}: must be a number`;
  if (value < option.low || value > option.high) return `${key}: is ${value}, must be ${option.low} .. ${option.high}`;
  if (option.whole && !Number.isInteger(value)) return `${key}: is ${value}, must be whole`;
  return "";
}

function apply(key, value) {
  const stage = stages.find((s) => s.key === key && s.alternatives.length > 0);
  if (stage) {
    for (const alternative of stage.alternatives) alternative.chosen = value === null ? alternative.default : alternative.name === value;
    stage.changed = stage.alternatives.some((alternative) => alternative.chosen !== alternative.default);
  } else {
    const option = every_option.get(key);
    option.value = value ?? filed(option);
    option.changed = option.value !== filed(option);
  }
}

/// The recorded scene, with the effect of those changes that are easily feigned.
function scene_now() {
  const scene = structuredClone(scenes[state.frame % scenes.length]);
  scene.frame = state.frame;
  scene.t = state.frame / rate_hz;
  for (const stage of Object.keys(scene.timing_ms)) scene.timing_ms[stage] *= 0.9 + 0.2 * Math.random();
  const reach = every_option.get("free_space_max_range").value;
  scene.free_space.ranges = scene.free_space.ranges.map((range) => range === null ? null : Math.min(range, reach));
  const by_boundary = stages.find((stage) => stage.key === "localization").alternatives.find((a) => a.name === "boundary").chosen;
  if (by_boundary) {
    scene.pose.kind = "two_lines";
    scene.why.pose = "two walls, told apart by the yellow goal";
  }
  return scene;
}

const types = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".yaml": "text/yaml" };

function answer(response, status, body, type = "application/json") {
  // The policy of the real server: what it would refuse must not work here either.
  response.writeHead(status, { "Content-Type": type, "Content-Security-Policy": "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'", "X-Content-Type-Options": "nosniff", "Cache-Control": "no-store" });
  response.end(body);
}

async function body_of(request) {
  let body = "";
  for await (const part of request) body += part;
  return body;
}

/// The real server refuses pages that are not its own; so a page that only works elsewhere does not work here either.
function is_own_page({ headers }) {
  return headers.origin === undefined || headers.origin === `http://${headers.host}`;
}

async function handle(request, response) {
  if (!is_own_page(request)) return answer(response, 403, "the request comes from a page elsewhere", "text/plain");
  const { pathname, searchParams } = new URL(request.url, "http://mock");
  if (pathname.startsWith("/api/training")) {
    return answer_part(response, "application/octet-stream", async () => training.answer(request.method, pathname.slice("/api/training".length), searchParams, await body_of(request)));
  }
  if (pathname.startsWith("/api/calibration")) {
    return answer_part(response, "image/png", async () => calibration.answer(request.method, pathname.slice("/api/calibration".length), await body_of(request)));
  }
  if (pathname === "/api/state" && request.method === "GET") return answer(response, 200, JSON.stringify(server_state()));
  if (pathname === "/api/recording" && request.method === "GET") return answer(response, 200, JSON.stringify(recording_now()));
  if (pathname === "/api/recording" && request.method === "PUT") {
    let on;
    try {
      ({ on } = JSON.parse(await body_of(request)));
    } catch { /* told below */ }
    if (typeof on !== "boolean") return answer(response, 400, "on is no boolean, must be true or false", "text/plain");
    record(on);
    return answer(response, 200, JSON.stringify(recording_now()));
  }
  if (pathname === "/api/stages" && request.method === "GET") return answer(response, 200, JSON.stringify(stages));
  if (pathname === "/api/stages" && request.method === "PUT") {
    let change;
    try {
      change = JSON.parse(await body_of(request));
    } catch {
      return answer(response, 400, "the request is no JSON", "text/plain");
    }
    const reasons = Object.entries(change).map(([key, value]) => refusal(key, value)).filter(Boolean);
    if (reasons.length > 0) return answer(response, 400, reasons.join("; "), "text/plain");
    for (const [key, value] of Object.entries(change)) apply(key, value);
    ++state.taken_over;
    return answer(response, 200, JSON.stringify(stages));
  }
  if (options.pages === "" || request.method !== "GET") return answer(response, 404, "not found", "text/plain");
  const file = path.join(options.pages, pathname === "/" ? "index.html" : path.normalize(pathname));
  if (!(await stat(file).catch(() => null))?.isFile()) return answer(response, 404, "not found", "text/plain");
  return answer(response, 200, await readFile(file), types[path.extname(file)] ?? "application/octet-stream");
}

/// Texts are JSON, bytes of `type`; null: there is no such request.
async function answer_part(response, type, ask) {
  try {
    const said = await ask();
    if (said === null) return answer(response, 404, "not found", "text/plain");
    return answer(response, 200, said, typeof said === "string" ? "application/json" : type);
  } catch (error) {
    if (error.status === undefined) throw error;
    return answer(response, error.status, error.message, "text/plain");
  }
}

function server_state() {
  return {
    version: "0.1.0", robot: "robot.yaml", source: { name: "mock", description: `${scenes.length} recorded scenes, over and over` },
    frame: state.frame, t: state.frame / rate_hz, rate_hz, frames: state.frame + 1, dropped: 0,
    configuration: { taken_over: state.taken_over, refusal: "" },
    recording: recording_now(),
    web: { viewers: [...sockets.clients].filter(({ channel }) => channel === "/ws/scene").length, clients: sockets.clients.size, sent: state.sent, dropped: state.dropped }, ended: false,
    field: {
      length: 8.22, width: 4.575, circle_radius: 1.0, halfway_line: true, areas: [{ depth: 1.0, width: 2.6 }],
      goals: [{ side: "+x", color: "blue", width: 1.5, depth: 0.5 }, { side: "-x", color: "yellow", width: 1.5, depth: 0.5 }],
    },
  };
}

const server = createServer((request, response) => handle(request, response).catch((error) => answer(response, 500, String(error), "text/plain")));
const sockets = new WebSocketServer({ noServer: true });
server.on("upgrade", (request, socket, head) => {
  const channel = new URL(request.url, "http://mock").pathname;
  if (!is_own_page(request) || !["/ws/scene", "/ws/picture", "/ws/frame"].includes(channel)) return socket.destroy();
  sockets.handleUpgrade(request, socket, head, (client) => { client.channel = channel; });
});

function publish(channel, message) {
  for (const client of sockets.clients) {
    if (client.channel !== channel || client.readyState !== client.OPEN) continue;
    if (client.bufferedAmount > 0) {
      ++state.dropped;
      continue;
    }
    client.send(message);
    ++state.sent;
  }
}

/// The JPEG with its frame as a comment, which pages freeze it with its scene by.
function numbered(jpeg, frame) {
  const text = Buffer.from(`frame ${frame}`);
  return Buffer.concat([jpeg.subarray(0, 2), Buffer.from([0xff, 0xfe, 0, text.length + 2]), text, jpeg.subarray(2)]);
}

setInterval(() => {
  ++state.frame;
  if (recording.on) {
    ++recording.frames;
    recording.bytes += 60_000;
  }
  publish("/ws/scene", JSON.stringify(scene_now()));
  publish("/ws/picture", numbered(pictures[state.frame % pictures.length], state.frame));
  publish("/ws/frame", calibration.frame(training.frame(state.frame, state.frame / rate_hz), state.frame));
}, 1000 / rate_hz);

server.listen(Number(options.port), "127.0.0.1", () => console.log(`http://127.0.0.1:${server.address().port}/`));
