import { describe, expect, test } from "vitest";
import { Refused } from "../link/api";
import type { Calibration, CalibrationApi, CalibrationChange, CalibrationResult } from "../link/calibration_api";
import { idle_calibration, some_view } from "../testing";
import { CalibrationModel, quick_ms, slow_ms, told_ms } from "./calibration_model";

const settle = (): Promise<void> => new Promise((done) => setTimeout(done));

/// Time goes on when it is told to.
class Clock {
  time = 0;
  private timers: { at: number; call: () => void }[] = [];
  now = (): number => this.time;
  after = (ms: number, call: () => void): (() => void) => {
    const timer = { at: this.time + ms, call };
    this.timers.push(timer);
    return () => { this.timers = this.timers.filter((other) => other !== timer); };
  };
  async pass(ms: number): Promise<void> {
    const end = this.time + ms;
    for (;;) {
      const next = this.timers.filter(({ at }) => at <= end).sort((a, b) => a.at - b.at)[0];
      if (next === undefined) break;
      this.timers = this.timers.filter((other) => other !== next);
      this.time = Math.max(this.time, next.at);
      next.call();
      await settle();
    }
    this.time = end;
  }
}

/// Answers at once, or when `answer` is called.
class Server implements CalibrationApi {
  state: Calibration = idle_calibration;
  is_held = false;
  fault: Error | null = null;
  asked: string[] = [];
  most_at_once = 0;
  private at_once = 0;
  private held: (() => void)[] = [];
  private async hold(name: string, make: () => Calibration): Promise<Calibration> {
    this.asked.push(name);
    this.most_at_once = Math.max(this.most_at_once, ++this.at_once);
    const made = make();   // what it was when it was asked for
    if (this.is_held) await new Promise<void>((go_on) => this.held.push(go_on));
    --this.at_once;
    if (this.fault) throw this.fault;
    return structuredClone(made);
  }
  async answer(): Promise<void> {
    this.held.shift()!();
    await settle();
  }
  calibration = (): Promise<Calibration> => this.hold("look", () => this.state);
  change = (change: CalibrationChange): Promise<Calibration> => this.hold("change", () => (this.state = { ...this.state, ...change }));
  capture = (): Promise<Calibration> => this.hold("capture", () => (this.state = { ...this.state, views: [...this.state.views, some_view(String(this.asked.length))] }));
  forget = (id: string): Promise<Calibration> => this.hold("forget", () => (this.state = { ...this.state, views: this.state.views.filter((view) => view.id !== id) }));
  forget_all = (): Promise<Calibration> => this.hold("forget_all", () => (this.state = { ...this.state, views: [] }));
  solve = (): Promise<Calibration> => this.hold("solve", () => (this.state = { ...this.state, is_solving: true }));
  save = (): Promise<Calibration> => this.hold("save", () => this.state);
  residuals = async (): Promise<Blob> => new Blob();
}

async function opened(): Promise<{ server: Server; clock: Clock; model: CalibrationModel }> {
  const [server, clock] = [new Server(), new Clock()];
  const model = new CalibrationModel(server, clock);
  model.open();
  await settle();
  return { server, clock, model };
}

const result: CalibrationResult = { model: "division", views: 3, rms_px: 0.1, cross_validated_rms_px: null, worst_sigma_px: 1, values: [], warnings: [] };

describe("asking", () => {
  test("is quick while it is on or solving, slow otherwise, and ends when the page is left", async () => {
    const { server, clock, model } = await opened();
    const asked_within = async (ms: number): Promise<number> => {
      const before = server.asked.length;
      await clock.pass(ms);
      return server.asked.length - before;
    };
    expect(await asked_within(10 * slow_ms)).toBe(10);
    await model.change({ is_on: true });
    expect(await asked_within(1000)).toBeGreaterThanOrEqual(1000 / quick_ms);
    server.state = { ...server.state, is_on: false, is_solving: true };
    await clock.pass(slow_ms);
    expect(await asked_within(1000)).toBe(1000 / quick_ms);
    model.close();
    expect(await asked_within(60000)).toBe(0);
    const before = server.asked.length;
    model.open();
    expect(server.asked.length, "at once").toBe(before + 1);
  });

  test("never has two questions on their way, however slow the answers are", async () => {
    const { server, clock, model } = await opened();
    server.is_held = true;
    await clock.pass(20000);
    model.close();
    model.open();
    await clock.pass(20000);
    expect(server.most_at_once).toBe(1);
    server.is_held = false;
    await server.answer();
    await clock.pass(1);
    expect(server.asked.length).toBeGreaterThan(2);
  });

  test("an answer from before a change is dropped", async () => {
    const { server, clock, model } = await opened();
    server.is_held = true;
    await clock.pass(slow_ms);
    const changed = model.change({ is_automatic: false });
    await settle();
    expect(model.view.value.pending).toEqual(["change"]);
    expect(model.view.value.wanted, "shown as chosen").toEqual({ is_automatic: false });
    await server.answer();   // to the question before it
    expect(model.view.value.calibration!.is_automatic).toBe(true);
    await server.answer();
    expect(await changed).toBe(true);
    expect(model.view.value.calibration!.is_automatic).toBe(false);
    expect(model.view.value.pending).toEqual([]);
    expect(model.view.value.wanted).toEqual({});
  });

  test("what was asked for before a change and comes after it is dropped, too", async () => {
    const { server, clock, model } = await opened();
    let late: (calibration: Calibration) => void = () => {};
    const usual = server.calibration;
    server.calibration = () => new Promise((done) => (late = done));
    await clock.pass(slow_ms);
    server.calibration = usual;
    await model.change({ is_on: true });
    late(idle_calibration);
    await settle();
    expect(model.view.value.calibration!.is_on).toBe(true);
  });

  test("goes on when the server is away or answers nonsense, which is told", async () => {
    const { server, clock, model } = await opened();
    server.fault = new TypeError("network");
    await clock.pass(slow_ms);
    expect(model.view.value.trouble).toMatch(/cannot be reached/);
    expect(model.view.value.calibration).not.toBeNull();
    server.fault = new Error("calibration: views must be a list");
    await clock.pass(slow_ms);
    expect(model.view.value.trouble).toMatch(/views must be a list/);
    server.fault = null;
    await clock.pass(slow_ms);
    expect(model.view.value.trouble).toBe("");
  });
});

describe("doing", () => {
  test("goes one after another, in the order of what was pressed", async () => {
    const { server, model } = await opened();
    server.asked = [];
    server.is_held = true;
    const all = [model.capture(), model.capture(), model.solve()];
    await settle();
    expect(server.asked).toEqual(["capture"]);
    expect(model.view.value.pending).toEqual(["capture", "capture", "solve"]);
    server.is_held = false;
    await server.answer();
    expect(await Promise.all(all)).toEqual([true, true, true]);
    expect(server.asked.filter((name) => name !== "look")).toEqual(["capture", "capture", "solve"]);
    expect(model.view.value.pending).toEqual([]);
  });

  test("a refusal is told until something else is asked for, and nothing changes", async () => {
    const { server, model } = await opened();
    server.solve = () => Promise.reject(new Refused(409, "there is 1 view, a calibration needs 3"));
    expect(await model.solve()).toBe(false);
    expect(model.view.value.refusal).toMatch(/needs 3/);
    expect(await model.capture()).toBe(true);
    expect(model.view.value.refusal).toBe("");
  });

  test("a view that was captured is told for a moment; those that were there, and those that are forgotten, are not", async () => {
    const { server, clock, model } = await opened();
    server.state = { ...idle_calibration, is_on: true, views: [some_view("1"), some_view("2")] };
    await clock.pass(slow_ms);
    expect(model.view.value.captured).toBe("2");
    await clock.pass(told_ms);
    expect(model.view.value.captured).toBeNull();
    await model.forget("1");
    await clock.pass(quick_ms);
    expect(model.view.value.captured).toBeNull();
    const again = new CalibrationModel(server, clock);
    again.open();
    await settle();
    expect(again.view.value.captured).toBeNull();
  });

  test("results are counted when they are others", async () => {
    const { server, clock, model } = await opened();
    server.state = { ...server.state, result };
    await clock.pass(slow_ms);
    await clock.pass(slow_ms);
    expect(model.view.value.results).toBe(1);
    server.state = { ...server.state, result: null };
    await clock.pass(slow_ms);
    server.state = { ...server.state, result: { ...result, rms_px: 0.2 } };
    await clock.pass(slow_ms);
    expect(model.view.value.results).toBe(2);
  });
});
