import { describe, expect, test } from "vitest";
import { Refused } from "../link/api";
import type { YuvFrame } from "../link/frame_bytes";
import { Observable } from "../link/observable";
import type { ImageEntry, Training, TrainingApi } from "../link/training_api";
import { random_frame } from "../testing";
import { Pictures } from "./pictures";
import { TrainingModel } from "./training_model";

function told(images: ImageEntry[]): Training {
  return { version: 1, is_saved: true, range: "limited", files: { samples: "", colors: "", images: "", refusal: "" }, images, samples: [], options: [],
    brightness: {}, history: [] };
}

/// Keeps the frame that was asked for while it still has it, else its newest.
function robot(has: number[]) {
  const asked: (number | null)[] = [];
  const kept = new Map<string, YuvFrame>();
  const state = { refuses: false };
  const api = {
    keep: async (frame: number | null): Promise<ImageEntry> => {
      asked.push(frame);
      if (state.refuses) throw new Refused(503, "no frame has come yet");
      const number = has.includes(frame ?? -1) ? frame! : has.at(-1)!;
      kept.set(`k${number}`, random_frame(number, 4, 2));
      return { id: `k${number}`, name: "", width: 4, height: 2, kept: false };
    },
    pixels: async (id: string): Promise<YuvFrame> => kept.get(id)!,
  } as unknown as TrainingApi;
  const training = new TrainingModel(api, { after: () => () => {} });
  // Opened before, and without pictures.
  training.view.set({ ...training.view.value, training: told([]) });
  return { asked, state, training, pictures: new Pictures(api, training, new Observable(false)) };
}

describe("drawing on the live picture", () => {
  test("keeps the frame that is shown, and shows it from then on, whatever comes live", async () => {
    const { asked, pictures } = robot([7, 8, 9]);
    const shown = random_frame(7, 4, 2);
    pictures.live.set(shown);
    const kept = pictures.hold();
    pictures.live.set(random_frame(9, 4, 2));
    expect(pictures.frame).toBe(shown);
    expect(await kept).toBe("k7");
    expect(asked).toEqual([7]);
    expect([pictures.image, pictures.frame?.frame]).toEqual(["k7", 7]);
    expect(await pictures.hold()).toBe("k7");
    expect(asked.length).toBe(1);
  });

  test("asks once, however often it is drawn meanwhile", async () => {
    const { asked, pictures } = robot([7]);
    pictures.live.set(random_frame(7, 4, 2));
    expect(await Promise.all([pictures.hold(), pictures.hold(), pictures.hold()])).toEqual(["k7", "k7", "k7"]);
    expect(asked).toEqual([7]);
  });

  test("a picture that the robot no longer has is not taken for another: nothing is drawn, and that is told", async () => {
    const { pictures, training } = robot([30, 31]);
    pictures.live.set(random_frame(7, 4, 2));
    expect(await pictures.hold()).toBeNull();
    expect(training.view.value.notice).toMatch(/no longer on the robot/);
    expect(pictures.image).toBe("k31");
  });

  test("a refusal is told, and the live picture goes on", async () => {
    const { pictures, state, training } = robot([]);
    state.refuses = true;
    pictures.live.set(random_frame(7, 4, 2));
    expect(await pictures.hold()).toBeNull();
    expect(training.view.value.notice).toMatch(/no frame has come yet/);
    expect(pictures.shown.value.kind).toBe("live");
  });

  test("without any picture there is nothing to hold", async () => {
    const { asked, pictures } = robot([1]);
    expect(await pictures.hold()).toBeNull();
    expect(asked).toEqual([]);
  });
});

test("a picture that is gone is neither shown nor remembered: its name may come again for another", async () => {
  const { pictures, training } = robot([7]);
  pictures.live.set(random_frame(7, 4, 2));
  await pictures.hold();
  expect(pictures.loaded.value.has("k7")).toBe(true);
  training.view.set({ ...training.view.value, training: told([]) });
  expect(pictures.loaded.value.size).toBe(0);
  expect(pictures.shown.value.kind).toBe("live");
});
