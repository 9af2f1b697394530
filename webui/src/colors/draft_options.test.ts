import { expect, test } from "vitest";
import type { Option } from "../link/api";
import type { TrainingApi } from "../link/training_api";
import { DraftOptions } from "./draft_options";
import { TrainingModel } from "./training_model";

const option = (key: string, high: number, whole: boolean): Option => (
  { key, unit: "1", low: 0, high, whole, meaning: key, default: 3, value: 3, changed: false });

function made() {
  const never = (): Promise<never> => new Promise(() => {});
  const model = new TrainingModel({ put_draft: never, training: never } as unknown as TrainingApi, { after: () => () => {} });
  model.view.set({ ...model.view.value, training: {
    version: 1, is_saved: true, range: "limited", files: { samples: "", colors: "", images: "", refusal: "" }, images: [], samples: [],
    options: [option("closing_px", 31, true), option("noise_margin", 20, false)], brightness: {}, history: [],
  } });
  return { model, options: new DraftOptions(model) };
}

test("a value in range is the draft's, the default is none, and null goes back to it", async () => {
  const { model, options } = made();
  await options.change("closing_px", 7);
  expect([model.draft.options, options.value_of("closing_px")]).toEqual([{ closing_px: 7 }, 7]);
  await options.change("closing_px", 3);
  expect(model.draft.options).toEqual({});
  await options.change("noise_margin", 2.5);
  await options.change("noise_margin", null);
  expect([model.draft.options, options.value_of("noise_margin")]).toEqual([{}, 3]);
});

test("what is out of range or not whole is refused here, stays typed, and leaves the draft", async () => {
  const { model, options } = made();
  for (const [value, why] of [[32, /must be 0 to 31/], [-1, /must be 0 to 31/], [2.5, /whole/]] as const) {
    await options.change("closing_px", value, String(value));
    expect(options.typed.value.errors.get("closing_px")).toMatch(why);
    expect(options.typed.value.refused.get("closing_px")).toBe(String(value));
    expect([model.draft.options, options.value_of("closing_px")]).toEqual([{}, null]);
  }
  options.forget("closing_px");
  expect(options.value_of("closing_px")).toBe(3);
});

test("a slider that is dragged is one step of undo, and whole where it must be", () => {
  const { model, options } = made();
  for (const value of [4.2, 5.7, 6.6]) options.slide("closing_px", value);
  expect(model.draft.options).toEqual({ closing_px: 7 });
  for (const value of [4, 5]) options.slide("noise_margin", value);
  model.undo();
  expect(model.draft.options).toEqual({ closing_px: 7 });
  model.undo();
  expect(model.draft.options).toEqual({});
});
