// Stands in for `tassilo monitor`: the same requests and channels, from a feigned game. For work on the page without robots or a build.
// usage: node mock/monitor.mjs [--port N] [--pages DIR] [--rate HZ] [--robots N] [--log]
// Prints its address as the first line, like the server does. Only node's own modules and ws.
//
// The game is a function of the time, so that looking back needs no memory. Robot 5 never knows its pose, 6 takes the mirrored one for as likely, 7 has
// troubles, 8 is stale most of the time, 9 went away; 1 to 4 have pictures.
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { readFile, stat } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { WebSocketServer } from "ws";

const here = path.dirname(fileURLToPath(import.meta.url));
const { values: options } = parseArgs({
  options: {
    port: { type: "string", default: "8081" }, pages: { type: "string", default: "" }, rate: { type: "string", default: "30" }, robots: { type: "string", default: "10" },
    log: { type: "boolean", default: false },
  },
});
const rate_hz = Number(options.rate);
const ids = Array.from({ length: Number(options.robots) }, (_, i) => i + 1);
const pictures = [1, 2, 3, 4].map((i) => readFileSync(path.join(here, "fixture", `${i}.jpg`)));
const has_picture = (id) => id <= 4;

const now = () => Date.now() / 1000;
const start = options.log ? 1764300000 : now() - 120;
const log_length = 90;
const newest = () => options.log ? start + log_length : now();
const oldest = () => options.log ? start : Math.max(start, now() - 300);

const field = {
  length: 8.22, width: 4.575, circle_radius: 1.0, halfway_line: true, areas: [{ depth: 1.0, width: 2.6 }],
  goals: [{ side: "+x", color: "blue", width: 1.5, depth: 0.5 }, { side: "-x", color: "yellow", width: 1.5, depth: 0.5 }],
};
const [half_x, half_y] = [field.length / 2, field.width / 2];
const robot_radius = 0.22;

/// When it was last heard at time t; before the start: never.
function last_heard(id, t) {
  if (id === 8) return start + Math.floor((t - start) / 4.6) * 4.6;
  if (id === 9) {
    // Here for 20 s of every 65; gone when the mock begins to be live.
    return Math.min(t, start + 25 + 65 * Math.floor((t - start - 25) / 65) + 20);
  }
  return t;
}

const wave = (t, id, speed, phase) => Math.sin(speed * (t - start) * (0.7 + 0.06 * id) + phase + 1.7 * id);
const rounded = (value, digits = 4) => Number(value.toFixed(digits));

/// Where it is: keepers in their goals, the others everywhere.
function place(id, t) {
  const keeper = id === 1 || id === 10;
  const side = id <= 5 ? -1 : 1;
  if (keeper) return { x: side * (half_x - 0.35), y: 0.55 * wave(t, id, 0.9, 0) };
  const row = ((id - 1) % 5) - 1.5;
  return { x: side * 0.9 + 2.2 * wave(t, id, 0.23, 0), y: 0.75 * row + 0.75 * wave(t, id, 0.41, 1) };
}

function ball_at(t) {
  return { x: 3.2 * Math.sin(0.43 * (t - start)), y: 1.7 * Math.sin(0.71 * (t - start) + 1) };
}

function pose_at(id, t) {
  const { x, y } = place(id, t);
  const ball = ball_at(t - 0.3);
  return { x, y, theta: Math.atan2(ball.y - y, ball.x - x) + 0.2 * wave(t, id, 1.3, 2) };
}

const field_of_view = 0.95;
const noise = (t, id, k) => Math.sin(37.7 * t + 11 * id + 5 * k) * 0.6 + Math.sin(91.3 * t + 3 * id + 7 * k) * 0.4;

function in_robot(pose, point) {
  const [dx, dy] = [point.x - pose.x, point.y - pose.y];
  return { x: Math.cos(pose.theta) * dx + Math.sin(pose.theta) * dy, y: -Math.sin(pose.theta) * dx + Math.cos(pose.theta) * dy };
}

function floor_values({ x, y }, spread) {
  const distance = Math.hypot(x, y);
  const bearing = Math.atan2(y, x);
  const [along, across] = [(spread * distance) ** 2 + 1e-4, (0.02 * distance) ** 2 + 1e-5];
  const [c, s] = [Math.cos(bearing), Math.sin(bearing)];
  const xy = c * s * (along - across);
  return {
    x: rounded(x), y: rounded(y), distance: rounded(distance), bearing: rounded(bearing), near: rounded(distance * (1 - spread)), far: rounded(distance * (1 + 2 * spread)),
    cov: [c * c * along + s * s * across, xy, xy, s * s * along + c * c * across].map((value) => rounded(value, 7)),
  };
}

/// From robot to wall or the next robot.
function free_range(pose, angle, others) {
  const [c, s] = [Math.cos(pose.theta + angle), Math.sin(pose.theta + angle)];
  let range = 6, state = "free";
  const wall = Math.min(c === 0 ? 99 : (Math.sign(c) * half_x - pose.x) / c, s === 0 ? 99 : (Math.sign(s) * half_y - pose.y) / s);
  if (wall < range) [range, state] = [wall, "blocked"];
  for (const other of others) {
    const [dx, dy] = [other.x - pose.x, other.y - pose.y];
    const along = dx * c + dy * s;
    const beside = Math.abs(-dx * s + dy * c);
    if (along <= 0 || beside >= robot_radius) continue;
    const hit = along - Math.sqrt(robot_radius ** 2 - beside ** 2);
    if (hit < range) [range, state] = [Math.max(hit, 0.05), "blocked"];
  }
  return { range: rounded(Math.max(range, 0.05)), state };
}

function scene_of(id, t) {
  const pose = pose_at(id, t);
  const others = ids.filter((other) => other !== id && last_heard(other, t) > t - 60).map((other) => ({ id: other, ...place(other, last_heard(other, t)) }));
  const visible = (point, reach) => Math.hypot(point.x, point.y) < reach && Math.abs(Math.atan2(point.y, point.x)) < field_of_view;
  const balls = [];
  const ball = in_robot(pose, ball_at(t));
  if (visible(ball, 5)) {
    balls.push(floor_values({ x: ball.x * (1 + 0.02 * noise(t, id, 1)), y: ball.y + 0.03 * noise(t, id, 2) }, 0.06));
    if (id % 4 === 3) balls.push(floor_values({ x: 1.5 + ball.x * 0.5, y: -ball.y - 0.4 }, 0.1));
  }
  const robots = others.map((other) => ({ ...in_robot(pose, other), id: other.id })).filter((other) => visible(other, 4)).map((other) => {
    const distance = Math.hypot(other.x, other.y);
    const foot = { x: other.x * (1 - robot_radius / distance), y: other.y * (1 - robot_radius / distance) };
    return { team: other.id <= 5 ? "cyan" : "magenta", ...floor_values({ x: foot.x + 0.03 * noise(t, id, other.id), y: foot.y }, 0.05), center: [rounded(other.x), rounded(other.y)], width: 0.42 };
  });
  const wall = (x0, y0, x1, y1, model) => {
    const [p, q] = [in_robot(pose, { x: x0, y: y0 }), in_robot(pose, { x: x1, y: y1 })];
    return { kind: "boundary", p: [rounded(p.x), rounded(p.y)], q: [rounded(q.x), rounded(q.y)], model };
  };
  const ahead = Math.cos(pose.theta) > 0 ? 1 : -1;
  const left = Math.sin(pose.theta) > 0 ? 1 : -1;
  const lines = [wall(ahead * half_x, pose.y - 0.8, ahead * half_x, pose.y + 0.8, ahead > 0 ? "x_plus" : "x_minus"),
                 wall(pose.x + ahead * 0.4, left * half_y, pose.x + ahead * 1.9, left * half_y, left > 0 ? "y_plus" : "y_minus")];
  const center = in_robot(pose, { x: 0, y: 0 });
  if (visible(center, 3)) lines.push({ kind: "circle", center: [rounded(center.x), rounded(center.y)], radius: 1 });
  const goals = field.goals.flatMap((goal) => {
    const x = goal.side === "+x" ? half_x : -half_x;
    const posts = [-1, 1].map((side) => in_robot(pose, { x, y: side * goal.width / 2 })).filter((post) => visible(post, 6));
    if (posts.length === 0) return [];
    const middle = posts.length === 2 ? in_robot(pose, { x, y: 0 }) : { x: null, y: null };
    return [{ color: goal.color, bearing: Math.atan2(posts[0].y, posts[0].x), x: middle.x, y: middle.y, posts: posts.map((post, i) => ({ side: i === 0 ? "left" : "right", x: rounded(post.x), y: rounded(post.y) })) }];
  });
  const sectors = 52;
  const angle_increment = (2 * field_of_view) / sectors;
  const seen = Array.from({ length: sectors }, (_, i) => free_range(pose, -field_of_view + (i + 0.5) * angle_increment, others));
  const free_space = {
    origin: [0.06, 0], angle_min: rounded(-field_of_view + 0.5 * angle_increment, 6), angle_increment: rounded(angle_increment, 9),
    ranges: seen.map(({ range }) => range), state: seen.map(({ state }) => state),
  };
  const before = in_robot(pose, ball_at(t - 0.1));
  const velocity_cov = [0.004, 0, 0, 0, 0, 0.004, 0, 0, 0, 0, 0.02, 0, 0, 0, 0, 0.02];
  const tracks = balls.length === 0 ? [] : [{ id: 1, kind: "ball", team: "unknown", x: rounded(ball.x), y: rounded(ball.y), vx: rounded((ball.x - before.x) * 10), vy: rounded((ball.y - before.y) * 10), cov: velocity_cov, age: 0 }];
  const sigma = 0.02 + 0.05 * (1 + wave(t, id, 0.5, 3)) + (id === 4 ? 0.25 : 0);
  return {
    pose: id === 5 ? null : {
      x: rounded(pose.x), y: rounded(pose.y), theta: rounded(pose.theta), cov: [sigma ** 2, 0.3 * sigma ** 2, 0, 0.3 * sigma ** 2, 0.6 * sigma ** 2, 0, 0, 0, 0.002],
      kind: pose_kind(id, t), age: pose_age(id, t), mirror: id === 6,
    },
    balls, goals, robots, lines, free_space, tracks,
  };
}

const pose_kind = (id, t) => id === 5 ? "none" : id === 6 ? "one_line" : pose_age(id, t) > 0.3 ? "predicted" : ["two_lines", "model", "goal"][id % 3];
const pose_age = (id, t) => id === 5 ? null : Math.max(0, rounded(2 * (wave(t, id, 0.31, 4) - 0.6), 2));

const roles = ["goalkeeper", "defender", "supporter", "striker", "midfield"];
const actions = ["stay", "go to ball", "dribble", "shoot", "turn to ball", "mark opponent"];
const plans = ["waiting", "planning", "path found", "no path"];

function robot_at(id, t) {
  const heard = last_heard(id, t);
  const age = t - heard;
  const scene = scene_of(id, heard);
  const old = age > 1;
  const picked = (words, seconds) => words[Math.floor((t - start) / seconds + id * 1.3) % words.length];
  return {
    id, team: id <= 5 ? "cyan" : "magenta", presence: age > 5 ? "gone" : age > 1 ? "stale" : "here", age: rounded(age, 3), has_picture: has_picture(id),
    scene: old ? { ...scene, balls: [], goals: [], robots: [], lines: [], free_space: null, tracks: [] } : scene,
    pose_kind: pose_kind(id, heard), pose_age: id === 5 ? null : rounded(pose_age(id, heard) + age, 3),
    role: id === 10 ? "" : roles[(id - 1) % 5], action: id === 10 ? "" : old ? actions[id % 6] : picked(actions, 3.7), planning_state: id === 10 ? "" : picked(plans, 5.3),
    frame_rate: old ? 0 : rounded(29.7 + 0.4 * noise(Math.floor(t), id, 0), 1), latency: id === 3 ? 0 : 0.018 + 0.003 * id,
    message_age: old ? null : rounded(Math.abs(0.006 * noise(Math.floor(5 * t), id, 3)) + (id === 7 ? 0.21 : 0), 4),
    messages_per_second: old ? 0 : rounded(29.8 + noise(Math.floor(t), id, 5) * 0.5 - (id === 7 ? 9 : 0), 1), bytes_per_second: old ? 0 : Math.round(41000 + 4000 * noise(Math.floor(t), id, 6)),
    loss: id === 10 ? null : old ? 1 : rounded(id === 7 ? 0.31 : Math.max(0, 0.01 * noise(Math.floor(t), id, 7)), 4), refused: id === 7 ? Math.floor((t - start) / 3) : 0, withheld: id === 2 ? Math.floor((t - start) * 2) : 0,
    clock_offset: id === 10 ? null : id === 7 ? 598.24 : rounded(0.0007 * (id - 5), 5),
    troubles: id === 7 ? ["two senders have its number", "its clock is 598 s ahead"] : [],
  };
}

/// What happened until a time: a list that only grows.
function news_until(t) {
  const news = ids.map((id) => ({ t: start + 0.05 * id, robot: id, text: "appeared" }));
  news.push({ t: start + 12, robot: 7, text: "two senders have its number" }, { t: start + 15, robot: 7, text: "its clock was set 598 s ahead" }, { t: start + 33, robot: null, text: "the field was changed to msl98" });
  for (let at = start + 25; at < t; at += 65) news.push({ t: at, robot: 9, text: "appeared" }, { t: at + 25, robot: 9, text: "is silent" });
  for (let at = start + 47; at < t; at += 40) news.push({ t: at, robot: 3, text: "lost its pose for 1.2 s" });
  return news.sort((a, b) => a.t - b.t).filter((item) => item.t <= t).map((item, i) => ({ number: i + 1, ...item }));
}

/// What all know together: those see it who know where they are; robot 5 is no teammate to anybody, because it does not.
function team_at(robots, t) {
  const seers = robots.filter(({ presence, scene }) => presence === "here" && scene.balls.length > 0 && scene.pose !== null && !scene.pose.mirror).map(({ id }) => id);
  const velocity = (now, before) => ({ x: rounded(now.x), y: rounded(now.y), vx: rounded((now.x - before.x) * 10), vy: rounded((now.y - before.y) * 10) });
  const thing = (sigma) => ({ cov: Array.from({ length: 16 }, (_, i) => (i % 5 === 0 ? sigma ** 2 : 0)), age: 0.02, robots: seers });
  const sigma = 0.12 / Math.sqrt(Math.max(seers.length, 1));
  return {
    ...(seers.length > 0 && { team_ball: { ...velocity(ball_at(t), ball_at(t - 0.1)), ...thing(sigma) } }),
    opponents: ids.includes(5) ? [{ id: 1, team: "cyan", ...velocity(place(5, t), place(5, t - 0.1)), ...thing(0.1) }] : [],
  };
}

function picture_at(t) {
  const robots = ids.filter((id) => t - last_heard(id, t) < 60).map((id) => robot_at(id, t));
  return {
    t, robots, ...team_at(robots, t), troubles: ids.includes(7) ? ["robot 7: 31 % of its messages do not come here"] : [], news: news_until(t).length,
    counts: { heard: Math.round((t - start) * 290), refused: Math.floor((t - start) / 3), late: 12, repeated: 3, bytes_per_second: robots.reduce((sum, robot) => sum + robot.bytes_per_second, 0) },
  };
}

function trails_at(t, seconds) {
  return { robots: ids.filter((id) => id !== 5).map((id) => {
    const points = [];
    for (let at = Math.ceil(Math.max(t - seconds, oldest()) * 10) / 10; at <= t; at += 0.1) {
      if (at - last_heard(id, at) > 0.2) continue;
      const { x, y } = place(id, at);
      points.push([rounded(at, 3), rounded(x), rounded(y)]);
    }
    return { id, points };
  }).filter(({ points }) => points.length > 0) };
}

const types = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".yaml": "text/yaml" };

function answer(response, status, body, type = "application/json") {
  // The policy of the real server: what it would refuse must not work here either.
  response.writeHead(status, { "Content-Type": type, "Content-Security-Policy": "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'", "X-Content-Type-Options": "nosniff", "Cache-Control": "no-store" });
  response.end(body);
}

/// The real server refuses pages that are not its own; so a page that only works elsewhere does not work here either.
function is_own_page({ headers }) {
  return headers.origin === undefined || headers.origin === `http://${headers.host}`;
}

async function handle(request, response) {
  if (!is_own_page(request)) return answer(response, 403, "the request comes from a page elsewhere", "text/plain");
  const { pathname, searchParams: query } = new URL(request.url, "http://mock");
  if (request.method !== "GET") return answer(response, 404, "not found", "text/plain");
  if (pathname.startsWith("/api/monitor")) return answer_monitor(response, pathname.slice("/api/monitor".length), query);
  if (options.pages === "") return answer(response, 404, "not found", "text/plain");
  const file = path.join(options.pages, pathname === "/" ? "monitor.html" : path.normalize(pathname));
  if (!(await stat(file).catch(() => null))?.isFile()) return answer(response, 404, "not found", "text/plain");
  return answer(response, 200, await readFile(file), types[path.extname(file)] ?? "application/octet-stream");
}

function answer_monitor(response, rest, query) {
  if (rest === "") {
    return answer(response, 200, JSON.stringify({
      version: "0.1.0", mode: options.log ? "log" : "live", name: options.log ? "game.mcap" : "domain 0, loopback", damage: "", field, begin: oldest(), end: newest(),
    }));
  }
  if (rest === "/news") return answer(response, 200, JSON.stringify(news_until(newest()).filter(({ number }) => number > Number(query.get("after") ?? 0)).slice(-200)));
  const t = Number(query.get("t") ?? NaN);
  if (!Number.isFinite(t)) return answer(response, 400, "t: is missing or no number", "text/plain");
  if (rest === "/at") {
    if (t < oldest()) return answer(response, 404, "there is nothing of this time", "text/plain");
    return answer(response, 200, JSON.stringify(picture_at(Math.floor(Math.min(t, newest()) * rate_hz) / rate_hz)));
  }
  if (rest === "/trails") {
    const seconds = Number(query.get("seconds") ?? 5);
    if (!(seconds >= 0 && seconds <= 60)) return answer(response, 400, `seconds: is ${query.get("seconds")}, must be 0..60`, "text/plain");
    return answer(response, 200, JSON.stringify(trails_at(Math.min(t, newest()), seconds)));
  }
  if (rest === "/picture") {
    const id = Number(query.get("robot") ?? NaN);
    if (!Number.isInteger(id)) return answer(response, 400, "robot: is missing or no number", "text/plain");
    // Live, pictures are only kept of one robot, so that both answers are met.
    if (!has_picture(id) || (!options.log && id > 2)) return answer(response, 404, "there is no picture of this time", "text/plain");
    return answer(response, 200, pictures[Math.floor(t * 4) % pictures.length], "image/jpeg");
  }
  return answer(response, 404, "not found", "text/plain");
}

const server = createServer((request, response) => handle(request, response).catch((error) => answer(response, 500, String(error), "text/plain")));
const sockets = new WebSocketServer({ noServer: true });
server.on("upgrade", (request, socket, head) => {
  const channel = new URL(request.url, "http://mock").pathname;
  if (!is_own_page(request) || !/^\/ws\/(team|picture\d{1,3})$/.test(channel)) return socket.destroy();
  sockets.handleUpgrade(request, socket, head, (client) => { client.channel = channel; });
});

function publish(channel, make) {
  let message = null;
  for (const client of sockets.clients) {
    // Newest only: a slow client misses messages.
    if (client.channel !== channel || client.readyState !== client.OPEN || client.bufferedAmount > 0) continue;
    client.send(message ??= make());
  }
}

if (!options.log) {
  let frame = 0;
  setInterval(() => {
    ++frame;
    publish("/ws/team", () => JSON.stringify(picture_at(now())));
    if (frame % 3 === 0) for (const id of ids.filter(has_picture)) publish(`/ws/picture${id}`, () => pictures[Math.floor(frame / 3 + id) % pictures.length]);
  }, 1000 / rate_hz);
}

server.listen(Number(options.port), "127.0.0.1", () => console.log(`http://127.0.0.1:${server.address().port}/`));
