import { describe, expect, test } from "vitest";
import { type Option, Refused } from "../link/api";
import type { ImageEntry, Quality, Result, Training, TrainingApi } from "../link/training_api";
import { random_table } from "../testing";
import type { ColorTable } from "./classify";
import type { ColorClass } from "./color_class";
import { type Draft, draft_of, options_of, type Sample, with_option, with_sample } from "./draft";
import { changed_elsewhere, lost_with_the_program, TrainingModel } from "./training_model";

const known: Option[] = [{ key: "closing_px", unit: "step", low: 1, high: 31, whole: true, meaning: "gaps", default: 5, value: 5, changed: false }];
const sample = (x: number, color: ColorClass = "green"): Sample => ({ image: "a", class: color, rectangle: [x, 0, x + 4, 4] });
const settle = (): Promise<void> => new Promise((done) => setTimeout(done));

/// A server with a draft; requests wait for `answer`, or not when `is_held` is false.
class Server implements TrainingApi {
  version = 3;
  draft: Draft = { samples: [], options: {}, brightness: {} };
  saved = true;
  images: ImageEntry[] = [];
  is_held = false;
  fault: Error | null = null;
  /// The request is done, but its answer is lost.
  loses_answer = false;
  asked: string[] = [];
  puts: Draft[] = [];
  most_at_once = 0;
  private held: (() => void)[] = [];

  private async hold<T>(name: string, make: () => T): Promise<T> {
    this.asked.push(name);
    if (this.is_held) {
      await new Promise<void>((go_on) => {
        this.held.push(go_on);
        this.most_at_once = Math.max(this.most_at_once, this.held.length);
      });
    }
    if (this.fault) throw this.fault;
    const made = structuredClone(make());
    if (this.loses_answer) throw new TypeError("network");
    return made;
  }
  async answer(): Promise<void> {
    this.held.shift()!();
    await settle();
  }
  get waiting(): number {
    return this.held.length;
  }
  /// What another browser does.
  others(draft: Draft): void {
    this.draft = draft;
    ++this.version;
    this.saved = false;
  }
  private told(): Training {
    return { version: this.version, is_saved: this.saved, range: "limited", files: { samples: "s", colors: "c", images: "i", refusal: "" }, images: this.images,
      samples: this.draft.samples, options: options_of(this.draft, known), brightness: this.draft.brightness, history: [] };
  }
  private made(seen: ColorClass): Result {
    return { version: this.version, table: random_table(this.version), classes: [], warnings: [],
      seen: { class: seen, density: new Uint8Array(65536), most: 0, brightness: new Array<number>(256).fill(0) } };
  }
  training = (): Promise<Training> => this.hold("training", () => this.told());
  result = (seen: ColorClass): Promise<Result> => this.hold(`result ${seen}`, () => this.made(seen));
  put_draft = (version: number, draft: Draft, seen: ColorClass): Promise<Result> => this.hold("put", () => {
    this.puts.push(draft);
    if (version !== this.version) throw new Refused(409, "the draft was changed");
    if ((draft.options["closing_px"] ?? 5) > 31) throw new Refused(400, "closing_px: is 50, must be 1 .. 31");
    this.draft = structuredClone(draft);
    ++this.version;
    this.saved = false;
    return this.made(seen);
  });
  quality = (): Promise<Quality> => this.hold("quality", () => ({ version: this.version, is_running: false, classes: { green: { recall: 0.9 } } }));
  table = (): Promise<ColorTable> => this.hold("table", () => random_table(1));
  keep = (): Promise<ImageEntry> => this.hold("keep", () => ({ id: "b", name: "b", width: 4, height: 4, kept: false }));
  pixels = (): never => { throw new Error("not asked here"); };
  forget = (): Promise<Training> => this.hold("forget", () => this.told());
  save = (version: number): Promise<Training> => this.hold("save", () => {
    if (version !== this.version) throw new Refused(409, "the draft was changed");
    this.saved = true;
    return this.told();
  });
  restore = (): Promise<Training> => this.hold("restore", () => this.told());
}

class Clock {
  waiting: { ms: number; call: () => void }[] = [];
  after(ms: number, call: () => void): () => void {
    const entry = { ms, call };
    this.waiting.push(entry);
    return () => { this.waiting = this.waiting.filter((other) => other !== entry); };
  }
  async ring(ms: number): Promise<void> {
    const due = this.waiting.filter((entry) => entry.ms === ms);
    this.waiting = this.waiting.filter((entry) => entry.ms !== ms);
    for (const { call } of due) call();
    await settle();
  }
}

async function opened() {
  const server = new Server();
  const clock = new Clock();
  const model = new TrainingModel(server, clock);
  model.open();
  await settle();
  const add = (x: number): void => model.edit(with_sample(model.draft, sample(x)), `sample ${x}`);
  const xs = (draft: Draft): number[] => draft.samples.map((s) => ("rectangle" in s ? s.rectangle[0] : -1));
  return { server, clock, model, add, xs };
}

describe("the draft and its server", () => {
  test("opened, it has draft, result and table in use", async () => {
    const { server, model } = await opened();
    expect(server.asked).toEqual(["training", "table", "result green"]);
    const { result, classifier, in_use, is_saved, trouble } = model.view.value;
    expect([result?.version, classifier?.table === result?.table, in_use !== null, is_saved, trouble]).toEqual([3, true, true, true, ""]);
  });

  test("one draft is on its way at a time, and meanwhile only the newest waits", async () => {
    const { server, model, add, xs } = await opened();
    server.is_held = true;
    for (let x = 1; x <= 9; ++x) {
      add(x);
      await settle();
    }
    expect(server.waiting).toBe(1);
    await server.answer();
    expect(server.waiting).toBe(1);
    await server.answer();
    expect(server.waiting).toBe(0);
    expect(server.puts.map(xs)).toEqual([[1], [1, 2, 3, 4, 5, 6, 7, 8, 9]]);
    expect(server.most_at_once).toBe(1);
    expect(model.view.value.result?.version).toBe(server.version);
  });

  test("what is undone before it was sent is never sent", async () => {
    const { server, model, add, xs } = await opened();
    server.is_held = true;
    add(1);
    await settle();
    add(2);
    model.undo();
    await server.answer();
    expect(server.waiting).toBe(0);
    expect(server.puts.map(xs)).toEqual([[1]]);
    model.undo();
    await settle();
    await server.answer();
    expect(xs(server.draft)).toEqual([]);
  });

  test("another class asks for its histograms, without a draft", async () => {
    const { server, model } = await opened();
    model.choose("red");
    model.choose("blue");
    await settle();
    expect(server.asked.slice(3)).toEqual(["result blue"]);
    expect(model.view.value.result?.seen?.class).toBe("blue");
  });

  test("the time of the event that made a draft comes with its result, and with no other", async () => {
    const { model } = await opened();
    model.edit(with_sample(model.draft, sample(1)), "sample", "", 1234);
    await settle();
    expect(model.view.value.drawn_at).toBe(1234);
    model.undo();
    await settle();
    expect(model.view.value.drawn_at).toBeNull();
  });
});

describe("another browser", () => {
  test("was faster: theirs is shown and told, and undo brings mine back, also to the server", async () => {
    const { server, model, add, xs } = await opened();
    add(1);
    await settle();
    server.others(with_sample(server.draft, sample(70)));
    add(2);
    await settle();
    expect(xs(model.draft)).toEqual([1, 70]);
    expect(model.view.value.notice).toBe(changed_elsewhere);
    expect(xs(server.draft)).toEqual([1, 70]);
    model.undo();
    await settle();
    expect(xs(server.draft)).toEqual([1, 2]);
    model.redo();
    await settle();
    expect(xs(server.draft)).toEqual([1, 70]);
  });

  test("is seen without an edit of ours, as one step", async () => {
    const { server, clock, model, xs } = await opened();
    server.others(with_sample(server.draft, sample(70)));
    await clock.ring(2000);
    expect(xs(model.draft)).toEqual([70]);
    expect(model.view.value.result?.version).toBe(server.version);
    expect(model.view.value.history.undoes).toBe("change from elsewhere");
    expect(model.view.value.is_saved).toBe(false);
  });

  test("only made the version grow: nothing is told, and ours is sent again", async () => {
    const { server, model, add, xs } = await opened();
    server.version += 5;
    add(1);
    await settle();
    expect(model.view.value.notice).toBe("");
    expect(xs(server.draft)).toEqual([1]);
  });

  test("what was told before an edit of ours does not undo it", async () => {
    const { server, clock, model, add, xs } = await opened();
    server.is_held = true;
    await clock.ring(2000);
    expect(server.waiting).toBe(1);
    add(1);
    await settle();
    while (server.waiting > 0) await server.answer();
    expect(xs(model.draft)).toEqual([1]);
    expect(xs(server.draft)).toEqual([1]);
    expect(model.view.value.notice).toBe("");
  });
});

describe("a server that was started anew", () => {
  const picture = (id: string, name: string, kept: boolean): ImageEntry => ({ id, name, width: 9, height: 9, kept });

  test("gives pictures other ids: samples follow those that are in files, and no step before can mean another picture", async () => {
    const { server, clock, model } = await opened();
    server.images = [picture("1", "a.png", true), picture("2", "live", false), picture("3", "b.png", true)];
    await clock.ring(2000);
    for (const image of ["1", "2", "3"]) model.edit(with_sample(model.draft, { ...sample(Number(image)), image }), "sample");
    await settle();
    server.version = 0;
    server.draft = { samples: [{ ...sample(3), image: "1" }], options: {}, brightness: {} };
    server.images = [picture("1", "b.png", true), picture("2", "a.png", true)];
    await clock.ring(2000);
    expect(model.draft.samples.map(({ image }) => image)).toEqual(["1"]);
    expect(model.view.value.notice).toBe(lost_with_the_program(1));
    model.undo();
    await settle();
    expect(server.draft.samples.map((s) => [s.image, "rectangle" in s && s.rectangle[0]])).toEqual([["2", 1], ["1", 3]]);
    expect(model.view.value.history.undoes).toBeNull();
  });
});

describe("trouble", () => {
  test("an answer that is lost is no conflict", async () => {
    const { server, clock, model, add, xs } = await opened();
    server.loses_answer = true;
    add(1);
    await settle();
    expect(model.view.value.trouble).toBe("the server cannot be reached");
    add(2);
    await settle();
    server.loses_answer = false;
    await clock.ring(1000);
    expect(xs(server.draft)).toEqual([1, 2]);
    expect([model.view.value.trouble, model.view.value.notice]).toEqual(["", ""]);
  });

  test("what the server refuses is taken back with its reason, and work goes on", async () => {
    const { server, model, add, xs } = await opened();
    add(1);
    await settle();
    model.edit(with_option(model.draft, "closing_px", 50), "closing_px");
    await settle();
    expect(model.view.value.notice).toMatch(/closing_px: is 50/);
    expect(xs(model.draft)).toEqual([1]);
    expect(model.draft.options).toEqual({});
    model.undo();
    await settle();
    expect(xs(server.draft)).toEqual([]);
  });

  test("while the server is away, edits stay and are sent when it is back", async () => {
    const { server, clock, add, xs } = await opened();
    server.fault = new TypeError("network");
    for (const x of [1, 2, 3]) add(x);
    await settle();
    await clock.ring(1000);
    server.fault = null;
    await clock.ring(1000);
    expect(xs(server.draft)).toEqual([1, 2, 3]);
  });
});

describe("saving", () => {
  test("it sends what is left to send first, and undo back to what was saved is saved", async () => {
    const { server, model, add } = await opened();
    add(1);
    expect(model.view.value.is_saved).toBe(false);
    expect(await model.save("first")).toBe(true);
    expect(server.saved).toBe(true);
    expect(server.asked.slice(-3)).toEqual(["put", "save", "table"]);
    expect(model.view.value.is_saved).toBe(true);
    add(2);
    expect(model.view.value.is_saved).toBe(false);
    model.undo();
    expect(model.view.value.is_saved).toBe(true);
  });

  test("a refusal is told, and nothing is lost", async () => {
    const { server, model, add, xs } = await opened();
    add(1);
    await settle();
    server.others(with_sample(server.draft, sample(70)));
    expect(await model.save("")).toBe(false);
    expect(model.view.value.notice).toMatch(/not saved/);
    expect(xs(model.draft)).toEqual([1, 70]);
    model.undo();
    await settle();
    expect(xs(server.draft)).toEqual([1]);
  });
});

test("a picture is needed as long as undo or redo may need it", async () => {
  const { model, add } = await opened();
  expect(model.needs("a")).toBe(false);
  add(1);
  model.undo();
  expect(model.needs("a")).toBe(true);
  model.edit(with_option(model.draft, "closing_px", 7), "closing_px");
  expect(model.needs("a")).toBe(false);
});

test("quality is asked when the draft is left alone, and forgotten with the next edit", async () => {
  const { server, clock, model, add } = await opened();
  await clock.ring(700);
  expect(server.asked).not.toContain("quality");   // there is nothing to judge
  add(1);
  await settle();
  await clock.ring(700);
  expect(model.view.value.quality?.version).toBe(server.version);
  add(2);
  expect(model.view.value.quality).toBeNull();
  await settle();
  await clock.ring(700);
  expect(model.view.value.quality?.version).toBe(server.version);
  expect(draft_of({ samples: [], options: known, brightness: {} }).options).toEqual({});
});
