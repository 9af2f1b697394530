import { readFileSync } from "node:fs";
import { describe, expect, test } from "vitest";
import type { Scene } from "../scene";
import { empty_scene } from "../testing";
import { draw_field_view, field_area } from "./field_view";
import { type Canvas2D, type Palette, palette_names } from "./pen";
import { recorder } from "./recorder";
import { draw_robot_view } from "./robot_view";
import { is_moving } from "./things";

const recorded = readFileSync(new URL("../../mock/fixture/scenes.jsonl", import.meta.url), "utf8").trim().split("\n").map((line) => JSON.parse(line) as Scene);
const palette = Object.fromEntries(palette_names.map((name) => [name, `the ${name}`])) as unknown as Palette;
const size = { width: 400, height: 300 };
const plan = { length: 8, width: 5, circle_radius: 1, areas: [{ depth: 1, width: 2 }], goals: [{ side: "+x" as const, color: "blue", width: 1, depth: 0.5 }] };

/// The scene of an uncalibrated camera.
function without_floor(scene: Scene): Scene {
  const unknown = { x: null, y: null, distance: null, bearing: null, near: null, far: null, cov: null };
  return {
    ...scene, pose: null, free_space: null, tracks: [], lines: scene.lines.flatMap((line) => (line.kind === "circle" ? [] : [{ ...line, p: null, q: null }])),
    balls: scene.balls.map((ball) => ({ ...ball, ...unknown })), robots: scene.robots.map((robot) => ({ ...robot, ...unknown, center: null, width: null })),
    goals: scene.goals.map((goal) => ({ ...goal, bearing: null, x: null, y: null, posts: [] })),
  };
}

const scenes: [string, Scene | null][] = [
  ["none", null], ["empty", empty_scene()], ...recorded.map((scene): [string, Scene] => [`recorded ${scene.frame}`, scene]),
  ["without calibration", without_floor(recorded[0]!)], ["mirrored", { ...recorded[0]!, pose: { ...recorded[0]!.pose!, mirror: true } }],
  ["without upper bounds", { ...recorded[0]!, robots: recorded[0]!.robots.map((robot) => ({ ...robot, far: null })) }],
];

describe.each(scenes)("drawing a scene: %s", (_, scene) => {
  const views: [string, (context: Canvas2D) => void][] = [
    ["robot", (context) => draw_robot_view(context, size, palette, 2, scene, 6)],
    ["field", (context) => draw_field_view(context, size, palette, 2, scene, plan)],
    ["field without a plan", (context) => draw_field_view(context, size, palette, 2, scene, null)],
  ];
  test.each(views)("%s: only finite numbers and colors of the palette reach the canvas", (_, draw) => {
    const { context, calls } = recorder();
    draw(context);
    expect(calls.length).toBeGreaterThan(0);
    for (const [name, ...values] of calls) {
      for (const value of values) if (typeof value === "number") expect(value, name).toSatisfy(Number.isFinite);
      if (name === "fillStyle" || name === "strokeStyle") expect(Object.values(palette)).toContain(values[0]);
    }
  });

  test("what one view leaves behind does not change the next", () => {
    const [first, second] = [recorder(), recorder()];
    draw_robot_view(first.context, size, palette, 1, scene, 6);
    draw_field_view(second.context, size, palette, 1, scene, plan);
    draw_robot_view(second.context, size, palette, 1, scene, 6);
    expect(second.calls.slice(-first.calls.length)).toEqual(first.calls);
  });
});

test("without a pose nothing is placed on the field", () => {
  const [with_things, without] = [recorder(), recorder()];
  draw_field_view(with_things.context, size, palette, 1, { ...recorded[0]!, pose: null }, plan);
  draw_field_view(without.context, size, palette, 1, null, plan);
  expect(with_things.calls).toEqual(without.calls);
});

test("without a plan the robot is in view wherever it is", () => {
  for (let x = -12; x <= 12; x += 0.7) {
    for (let y = -8; y <= 8; y += 0.7) {
      const area = field_area(null, { ...empty_scene(), pose: { x, y, theta: 0, cov: [], kind: "model", age: 0, mirror: false } });
      expect(area.x_min <= x && x <= area.x_max && area.y_min <= y && y <= area.y_max).toBe(true);
    }
  }
});

test("what may as well stand still has no arrow", () => {
  const track = { id: 1, kind: "ball" as const, team: "unknown" as const, x: 0, y: 0, vx: 1, vy: 0, age: 0 };
  const cov = (variance: number): number[] => [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, variance, 0, 0, 0, 0, variance];
  expect(is_moving({ ...track, cov: cov(0.01) })).toBe(true);
  expect(is_moving({ ...track, cov: cov(1) })).toBe(false);
  expect(is_moving({ ...track, cov: [] })).toBe(false);
});
