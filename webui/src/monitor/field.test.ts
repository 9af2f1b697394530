import { describe, expect, test } from "vitest";
import { type Palette, palette_names } from "../canvas/pen";
import { apply } from "../canvas/transform";
import { recorder } from "../canvas/recorder";
import type { FieldPlan } from "../link/api";
import type { Point } from "../scene";
import { numbers_from } from "../testing";
import { canvas_from_camera, type FieldCamera, panned, zoomed } from "./field_camera";
import { draw_team, type FieldContent, robot_at, team_area } from "./field_drawing";
import { all_layers, layers_from, usual_layers } from "./layers";
import { measure_words, measured } from "./measuring";
import { pose, robot, team_picture, team_thing } from "./testing";
import { Trails } from "./trails";
import { share_within, usual_share } from "./windows";

const palette = Object.fromEntries(palette_names.map((name) => [name, `the ${name}`])) as unknown as Palette;
const size = { width: 800, height: 500 };
const plan: FieldPlan = {
  length: 8, width: 5, circle_radius: 1, areas: [{ depth: 1, width: 2 }], segments: [[0, 0, 1, 1]], arcs: [[4, 2.5, 0.5, 3.14, 4.71]], walls: { x: [-4.5, 4.5], y: [-3, 3] },
  goals: [{ side: "+x", color: "blue", width: 1, depth: 0.5 }, { side: "-x", color: "white", width: 1, depth: 0.5 }],
};
const fields: [string, FieldPlan | null][] = [["walled", plan], ["small", { length: 2.19, width: 1.58 }], ["large", { length: 22, width: 14, halfway_line: true }], ["none", null]];

function content(of: Partial<FieldContent> = {}): FieldContent {
  return { picture: team_picture(10, [robot(1, {}, pose(1, 0.5)), robot(2, {}, pose(-2, -1, 2))]), plan, layers: usual_layers, trails: new Trails(), camera: null, selected: null, measure: null, ...of };
}

/// With a scene that has one of everything.
function full_robot(id: number, of: Parameters<typeof robot>[1] = {}): ReturnType<typeof robot> {
  const one = robot(id, of, pose(0.5 * id - 2, 0.3 * id, id));
  one.scene.balls = [{ x: 1, y: 0.2, distance: 1, bearing: 0.2, near: 0.9, far: null, cov: [0.1, 0, 0, 0.1] }, { x: null, y: null, distance: null, bearing: null, near: null, far: null, cov: null }];
  one.scene.goals = [{ color: "yellow", bearing: 0, x: null, y: null, posts: [{ side: "left", x: 2, y: 1 }] }];
  one.scene.robots = [{ team: "magenta", x: 1, y: -1, distance: 1.4, bearing: -0.8, near: 1.3, far: 1.5, cov: [0.1, 0, 0, 0.1], center: null, width: null }];
  one.scene.lines = [{ kind: "boundary", p: [1, 1], q: [2, 1], model: null }, { kind: "circle", center: [1, 1], radius: 1 }];
  one.scene.free_space = { origin: [0, 0], angle_min: -0.1, angle_increment: 0.1, ranges: [1, null, 2], state: ["free", "unseen", "blocked"] };
  one.scene.tracks = [{ id: 1, kind: "ball", team: "unknown", x: 1, y: 0, vx: 1, vy: 0, cov: Array.from({ length: 16 }, (_, i) => (i % 5 === 0 ? 0.001 : 0)), age: 0.2 }];
  return one;
}

describe.each(fields)("the field window on a field: %s", (_, field) => {
  const robots = [full_robot(1), full_robot(2, { presence: "stale", age: 2 }), full_robot(3, { presence: "gone", age: 20, team: "unknown" }), robot(4, {}, null), full_robot(255, { team: "magenta" })];
  robots[0]!.scene.pose!.mirror = true;
  const everything = Object.fromEntries(all_layers.map(({ key }) => [key, true])) as FieldContent["layers"];
  const together = { team_ball: { ...team_thing(0.5, 0.2), vx: 1, age: 0.5 }, opponents: [{ ...team_thing(-1, 0), id: 3, team: "magenta" as const }, { ...team_thing(0, 1), id: 4, team: "unknown" as const, cov: [] }] };
  const full_picture = { ...team_picture(10, robots), ...together };
  const trails = new Trails();
  for (let t = 9; t < 10; t += 0.1) trails.add(team_picture(t, robots));

  test("only finite numbers and colors of the palette reach the canvas, and it is left as it was", () => {
    const { context, calls } = recorder();
    draw_team(context, size, palette, 2, content({ picture: full_picture, plan: field, layers: everything, trails, selected: 2, measure: { from: [0, 0], to: [0, 0] } }));
    for (const [name, ...values] of calls) {
      for (const value of values) if (typeof value === "number") expect(value, name).toSatisfy(Number.isFinite);
      if (name === "fillStyle" || name === "strokeStyle") expect(Object.values(palette)).toContain(values[0]);
    }
    const written = calls.filter(([name]) => name === "fillText").map(([, text]) => text);
    for (const id of ["1", "2", "3", "255"]) expect(written).toContain(id);
    expect(written, "who has no pose is nowhere").not.toContain("4");
    expect(written).toContain("gone 20 s");
    expect(calls.filter(([name]) => name === "globalAlpha").pop()).toEqual(["globalAlpha", 1]);
  });

  test("every layer changes something, and is the only one that does", () => {
    const drawn = (layers: FieldContent["layers"]): string => {
      const { context, calls } = recorder();
      draw_team(context, size, palette, 1, content({ picture: full_picture, plan: field, layers, trails }));
      return JSON.stringify(calls);
    };
    const all = drawn(everything);
    for (const { key } of all_layers) expect(drawn({ ...everything, [key]: false }) === all, key).toBe(false);
  });

  test("a click hits the robot that is there, the nearest of several, and nothing elsewhere", () => {
    const random = numbers_from(4, -1, 1);
    for (let i = 0; i < 100; ++i) {
      const [half_x, half_y] = [(field?.length ?? 8) / 2, (field?.width ?? 5) / 2];
      const two = [robot(1, {}, pose(half_x * random(), half_y * random())), robot(2, {}, pose(half_x * random(), half_y * random()))];
      const shown = content({ picture: team_picture(0, two), plan: field, camera: i % 2 === 0 ? null : { center: [0.2, 0.1], zoom: 1.5 } });
      const place = (index: number): Point => apply(canvas_from_camera(shown.camera, team_area(shown), size), [two[index]!.scene.pose!.x, two[index]!.scene.pose!.y]);
      expect(robot_at(shown, place(0), size, 1)).toBe(1);
      expect(robot_at(shown, place(1), size, 1)).toBe(2);
      const [a, b] = [place(0), place(1)];
      const far: Point = [Math.max(a[0], b[0]) + 100, a[1]];
      expect(robot_at(shown, far, size, 1)).toBe(null);
    }
  });
});

describe("the team's ball and opponents", () => {
  const drawn = (of: Partial<FieldContent["picture"] & object>, layers = usual_layers) => {
    const { context, calls } = recorder();
    const shown = content({ picture: { ...team_picture(10, []), ...of }, layers });
    draw_team(context, size, palette, 1, shown);
    return { calls, place: (at: Point) => apply(canvas_from_camera(null, team_area(shown), size), at) };
  };
  /// Discs and rings around a point, with how they were painted.
  const rounds = ({ calls, place }: ReturnType<typeof drawn>, at: Point) => {
    const [x, y] = place(at);
    return calls.flatMap(([name, ...values], i) => {
      if (name !== "arc" || Math.hypot(Number(values[0]) - x, Number(values[1]) - y) > 1e-6) return [];
      const until = calls.findIndex(([later], j) => j > i && (later === "fill" || later === "stroke"));
      const last = (what: string) => calls.slice(0, until).filter(([name]) => name === what).pop()?.[1];
      return [{ how: calls[until]![0], color: last(calls[until]![0] === "fill" ? "fillStyle" : "strokeStyle"), alpha: Number(last("globalAlpha")) }];
    });
  };

  test("a filled ball where the team knows it, an outline where an opponent is, nothing where nobody knows", () => {
    const shown = drawn({ team_ball: team_thing(1, -0.5), opponents: [{ ...team_thing(-1, 1), id: 1, team: "magenta" }] });
    expect(rounds(shown, [1, -0.5])).toContainEqual({ how: "fill", color: palette.ball, alpha: 1 });
    expect(rounds(shown, [-1, 1])).toContainEqual({ how: "stroke", color: palette.magenta, alpha: 1 });
    expect(rounds(shown, [-1, 1])).not.toContainEqual(expect.objectContaining({ how: "fill", color: palette.magenta }));
    expect(rounds(drawn({}), [1, -0.5])).toEqual([]);
  });
  test("the older, the fainter, but never gone while it is told", () => {
    const alphas = [0, 0.5, 1, 1.5, 2, 5].map((age) => Math.max(...rounds(drawn({ team_ball: { ...team_thing(1, 1), age } }), [1, 1]).map(({ alpha }) => alpha)));
    expect(alphas).toEqual([...alphas].sort((a, b) => b - a));
    expect(alphas[0]).toBe(1);
    expect(alphas[2]).toBeLessThan(alphas[0]!);
    expect(alphas[5]).toBeGreaterThan(0.2);
  });
  test("its ellipse holds nine of ten", () => {
    const sigma = 0.4;
    const cov = Array.from({ length: 16 }, (_, i) => (i % 5 === 0 ? sigma ** 2 : 0));
    const shown = drawn({ team_ball: { ...team_thing(1, 1), cov } });
    const without = drawn({ team_ball: { ...team_thing(1, 1), cov } }, { ...usual_layers, uncertainty: false });
    expect(without.calls.length).toBeLessThan(shown.calls.length);
    const [x, y] = shown.place([1, 1]);
    const unit = shown.place([2, 1])[0] - x;
    // Of a round Gaussian, 1 - exp(-r^2 / 2) lie within r.
    const radii = shown.calls.filter(([name]) => name === "lineTo").map(([, u, v]) => Math.hypot(Number(u) - x, Number(v) - y) / unit / sigma);
    expect(radii.filter((r) => Math.abs(1 - Math.exp((-r * r) / 2) - 0.9) < 1e-6).length).toBeGreaterThanOrEqual(47);
  });
});

describe("zoom and pan", () => {
  test("the point under the pointer stays there, until the field's edge", () => {
    const random = numbers_from(1, 0, 1);
    const area = team_area({ picture: null, plan });
    let camera: FieldCamera = null;
    for (let i = 0; i < 100; ++i) {
      const anchor: Point = [size.width * (0.4 + 0.2 * random()), size.height * (0.4 + 0.2 * random())];
      const place = (c: FieldCamera): Point => {
        const { a, e, d, f } = canvas_from_camera(c, area, size);
        return [(anchor[0] - e) / a, (anchor[1] - f) / d];
      };
      const next = zoomed(camera, 0.8 + 0.5 * random(), anchor, area, size);
      const [before, after] = [place(camera), place(next)];
      const inside = next !== null && Math.abs(next.center[0]) < area.x_max && Math.abs(next.center[1]) < area.y_max;
      if (inside) expect(Math.hypot(before[0] - after[0], before[1] - after[1])).toBeLessThan(1e-9);
      camera = next;
      if (camera !== null && camera.zoom > 20) camera = null;
    }
  });
  test("the field is never lost out of sight", () => {
    const area = team_area({ picture: null, plan });
    let camera: FieldCamera = null;
    for (let i = 0; i < 50; ++i) camera = panned(zoomed(camera, 1.1, [0, 0], area, size), [500, -300], area, size);
    expect(camera!.center[0]).toBeGreaterThanOrEqual(area.x_min);
    expect(camera!.center[1]).toBeGreaterThanOrEqual(area.y_min);
    expect(camera!.zoom).toBeLessThanOrEqual(40);
  });
  test("without a plan every robot is in sight", () => {
    const area = team_area({ picture: team_picture(0, [robot(1, {}, pose(-14, 3)), robot(2, {}, pose(2, -9))]), plan: null });
    expect(area.x_min).toBeLessThan(-14);
    expect(area.y_min).toBeLessThan(-9);
  });
});

test("measuring: distance, both ways and the angle; turned round it is turned round", () => {
  expect(measured({ from: [1, 1], to: [4, 5] })).toEqual({ distance: 5, dx: 3, dy: 4, angle: Math.atan2(4, 3) });
  expect(measured({ from: [1, 1], to: [1, 1] }).angle).toBe(null);
  expect(measure_words({ from: [0, 0], to: [-1, 0] })).toBe("1.00\u00a0m, dx −1.00, dy 0.00, 180.0°");
});

test("layers are remembered by name; new ones are as usual, nonsense is none", () => {
  expect(layers_from('{"balls": false, "unheard_of": true}')).toEqual({ ...usual_layers, balls: false });
  for (const nonsense of [null, "", "null", "7", "[1", '{"balls": "no"}']) expect(layers_from(nonsense)).toEqual(usual_layers);
});

test("neither window can be pushed out of the page", () => {
  expect([-1, 0.5, 2].map(share_within)).toEqual([0.2, 0.5, 0.85]);
  for (let height = 100; height < 3000; height += 50) expect(share_within(usual_share(height))).toBe(usual_share(height));
});

describe("trails", () => {
  const drive = (trails: Trails, from: number, to: number, of: Parameters<typeof robot>[1] = {}): void => {
    for (let i = Math.round(from * 30); i < Math.round(to * 30); ++i) trails.add(team_picture(i / 30, [robot(1, of, pose(0.2 * (i / 30), 0))]));
  };
  test("are of the last 5 s, at most 10 points a second", () => {
    const trails = new Trails();
    drive(trails, 0, 20);
    const [way] = trails.ways(1, 20);
    expect(way!.length).toBeGreaterThan(35);
    expect(way!.length).toBeLessThanOrEqual(51);
    expect(way![0]![0]).toBeGreaterThanOrEqual(0.2 * 15 - 1e-9);
  });
  test("have a gap where the robot was silent or jumped", () => {
    const trails = new Trails();
    drive(trails, 0, 1);
    drive(trails, 1, 2.5, { age: 1, presence: "stale" });
    drive(trails, 2.5, 3);
    expect(trails.ways(1, 3)).toHaveLength(2);
    trails.add(team_picture(3.1, [robot(1, {}, pose(-3, 2))]));
    expect(trails.ways(1, 3.1)).toHaveLength(3);
  });
  test("never show what comes after the time that is shown", () => {
    const trails = new Trails();
    drive(trails, 0, 4);
    expect(trails.ways(1, 2).flat().every(([x]) => x <= 0.4 + 1e-9)).toBe(true);
    trails.add(team_picture(1, [robot(1, {}, pose(0.2, 0))]));
    expect(trails.ways(1, 4).flat().every(([x]) => x <= 0.2 + 1e-9), "back in time, the rest is forgotten").toBe(true);
  });
  test("keep what is newer than the server's", () => {
    const trails = new Trails();
    drive(trails, 2, 3);
    trails.take([{ id: 1, points: [[1.8, 0.36, 0], [1.9, 0.38, 0], [2.05, 0.41, 0]] }], 2.05);
    const [way] = trails.ways(1, 3);
    expect(way![0]).toEqual([0.36, 0]);
    expect(way!.length).toBeGreaterThan(10);
  });
});
