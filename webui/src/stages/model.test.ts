import { describe, expect, test } from "vitest";
import { type Api, type Change, type Option, Refused, type ServerState, type Stage } from "../link/api";
import { changed_keys, matching, parsed_number, StagesModel } from "./model";

function option(key: string, value = 1, changed = false): Option {
  return { key, unit: "1", low: 0, high: 10, whole: false, meaning: `what ${key} means`, default: 1, value, changed };
}

function stage(part: Partial<Stage> = {}): Stage {
  return {
    key: "balls", meaning: "the ball",
    alternatives: [
      { name: "sphere", meaning: "an outline", default: true, chosen: true, options: [] },
      { name: "blob", meaning: "a large region", default: false, chosen: false, options: [option("blob_area")] },
    ],
    options: [option("ball_max"), option("ball_min")],
    ...part,
  };
}

/// A server that takes one number, and answers when the test says so.
class Server implements Api {
  asked: Change[] = [];
  private value = 1;
  private held: (() => void)[] = [];

  state(): Promise<ServerState> {
    throw new Error("not asked here");
  }
  stages(): Promise<Stage[]> {
    return this.answer(() => this.now());
  }
  change(change: Change): Promise<Stage[]> {
    this.asked.push(change);
    return this.answer(() => {
      const value = change["ball_max"];
      if (typeof value === "number" && value > 10) throw new Refused(400, `ball_max: is ${value}, must be 0 .. 10`);
      this.value = value === null ? 1 : Number(value ?? this.value);
      return this.now();
    });
  }
  async let_answer(): Promise<void> {
    this.held.shift()!();
    await new Promise((settled) => setTimeout(settled));
  }
  get waiting(): number {
    return this.held.length;
  }
  private now(): Stage[] {
    return [stage({ options: [option("ball_max", this.value, this.value !== 1)] })];
  }
  private answer(make: () => Stage[]): Promise<Stage[]> {
    return new Promise((resolve, reject) => this.held.push(() => {
      try {
        resolve(make());
      } catch (error) {
        reject(error);
      }
    }));
  }
}

async function loaded() {
  const server = new Server();
  const model = new StagesModel(server);
  void model.refresh();
  await settle();
  await server.let_answer();
  const value = (): number => model.view.value.stages![0]!.options[0]!.value;
  return { server, model, value };
}
const settle = (): Promise<void> => new Promise((done) => setTimeout(done));

describe("changes", () => {
  test("one is asked for at a time, in order, and the last one's answer stays", async () => {
    const { server, model, value } = await loaded();
    for (const number of [2, 3, 4]) void model.change("ball_max", number, String(number));
    void model.refresh();   // would tell less than the changes before it
    for (let n = 1; n <= 3; ++n) {
      await settle();
      expect(server.asked.length).toBe(n);
      expect(server.waiting).toBe(1);
      await server.let_answer();
      expect(value()).toBe(n + 1);
    }
    expect(server.waiting).toBe(0);
    expect(model.view.value.pending.size).toBe(0);
  });

  test("a refused one leaves the value, and its reason and text stay until the next try", async () => {
    const { server, model, value } = await loaded();
    void model.change("ball_max", 50, "50");
    await settle();
    await server.let_answer();
    expect(value()).toBe(1);
    expect(model.view.value.errors.get("ball_max")).toBe("ball_max: is 50, must be 0 .. 10");
    expect(model.view.value.refused.get("ball_max")).toBe("50");
    void model.change("ball_max", 5, "5");
    expect(model.view.value.errors.size).toBe(0);
    await settle();
    await server.let_answer();
    expect(model.view.value.refused.size).toBe(0);
    expect(value()).toBe(5);
  });

  test("resetting all asks for the robot file's value of what is changed, in one request", async () => {
    const { server, model, value } = await loaded();
    await model.reset_all();
    expect(server.asked).toEqual([]);
    void model.change("ball_max", 5, "5");
    await settle();
    await server.let_answer();
    void model.reset_all();
    await settle();
    await server.let_answer();
    expect(server.asked[1]).toEqual({ ball_max: null });
    expect(value()).toBe(1);
  });

  test("what is no number is refused here, and forgotten when it is taken back", async () => {
    const { server, model } = await loaded();
    model.refuse("ball_max", "must be a number", "many");
    expect(model.view.value.errors.get("ball_max")).toBe("must be a number");
    model.forget("ball_max");
    expect([model.view.value.errors.size, model.view.value.refused.size, server.asked.length]).toEqual([0, 0, 0]);
  });
});

describe("search", () => {
  test("without words all is there", () => {
    expect(matching(stage(), "  ", false)).toEqual(stage());
  });

  test("a hit in an option leaves that option; in the stage, all of it; nowhere, nothing", () => {
    expect(matching(stage(), "ball_max", false)!.options.map(({ key }) => key)).toEqual(["ball_max"]);
    expect(matching(stage(), "balls", false)!.options.length).toBe(2);
    expect(matching(stage(), "nowhere", false)).toBeNull();
  });

  test("alternatives are found by name, with their options, and all stay to be chosen from", () => {
    const found = matching(stage(), "blob", false)!;
    expect(found.alternatives.map(({ name, options }) => [name, options.length])).toEqual([["sphere", 0], ["blob", 1]]);
    expect(found.options).toEqual([]);
  });

  test("more words never find more", () => {
    const size = (query: string): number => {
      const found = matching(stage(), query, false);
      return found === null ? 0 : 1 + found.options.length + found.alternatives.flatMap(({ options }) => options).length;
    };
    for (const query of ["ball", "what", "max", "blob", "a"]) {
      for (const more of ["ball", "min", "means", "zzz"]) expect(size(`${query} ${more}`), `${query} ${more}`).toBeLessThanOrEqual(size(query));
    }
  });

  test("changed only: what is changed, and nothing where nothing is", () => {
    expect(matching(stage(), "", true)).toBeNull();
    const changed = stage({ options: [option("ball_max", 2, true), option("ball_min")] });
    expect(matching(changed, "", true)!.options.map(({ key }) => key)).toEqual(["ball_max"]);
    expect(matching(stage({ changed: true }), "", true)!.options).toEqual([]);
    expect(changed_keys([changed, stage({ changed: true })])).toEqual(["ball_max", "balls"]);
  });
});

test("numbers are read as people and robot files write them, and nothing else is one", () => {
  for (const [text, number] of [["3", 3], [" 0.5 ", 0.5], [".5", 0.5], ["2.", 2], ["-1", -1], ["1e-3", 0.001], ["0,25", 0.25]] as const) {
    expect(parsed_number(text), text).toBe(number);
  }
  for (const text of ["", " ", "-", ".", "1e", "many", "1 2", "1,000,000", "0x10", "Infinity", "NaN", "3m"]) expect(parsed_number(text), text).toBeNull();
  for (const number of [0, 1, -2.5, 1e-7, 1e21, 0.1 + 0.2]) expect(parsed_number(String(number))).toBe(number);
});
