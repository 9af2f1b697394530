import { describe, expect, test } from "vitest";
import { type Recording, RecordingModel, duration, place, words } from "./recording_model";

const idle: Recording = { on: false, finishing: false, folder: "/home/r/recordings", name: "", parts: 0, seconds: 0, frames: 0, bytes: 0, dropped: 0, trouble: "" };

describe("recording", () => {
  test("what was pressed goes to the server once, and its answer is shown", async () => {
    const asked: boolean[] = [];
    let answer: (recording: Recording) => void = () => {};
    const model = new RecordingModel((on) => {
      asked.push(on);
      return new Promise((resolve) => (answer = resolve));
    });
    await model.toggle();
    expect(asked, "nothing is known of the server yet").toEqual([]);
    model.told(idle);
    const pressed = model.toggle();
    void model.toggle();
    expect(asked).toEqual([true]);
    expect(model.view.value.pending).toBe(true);
    model.told(idle);   // asked for before
    answer({ ...idle, on: true });
    await pressed;
    expect(model.view.value).toEqual({ recording: { ...idle, on: true }, pending: false, refusal: "" });
    model.told({ ...idle, on: true, frames: 3 });
    expect(model.view.value.recording!.frames).toBe(3);
    void model.toggle();
    expect(asked).toEqual([true, false]);
  });

  test("a refusal is shown until it is tried again, and changes nothing", async () => {
    let refuses = true;
    const model = new RecordingModel(async (on) => {
      if (refuses) throw new Error("recordings: is no folder");
      return { ...idle, on };
    });
    model.told(idle);
    await model.toggle();
    expect(model.view.value).toEqual({ recording: idle, pending: false, refusal: "recordings: is no folder" });
    model.told({ ...idle, seconds: 1 });
    expect(model.view.value.refusal).toBe("recordings: is no folder");
    refuses = false;
    await model.toggle();
    expect(model.view.value).toEqual({ recording: { ...idle, on: true }, pending: false, refusal: "" });
  });

  test("a server that does not record has no button", () => {
    const model = new RecordingModel();
    model.told(null);
    expect(model.view.value.recording).toBeNull();
  });

  test("durations", () => {
    for (const [seconds, text] of [[0, "0:00"], [7.9, "0:07"], [723, "12:03"], [3723, "1:02:03"], [-1, "0:00"]] as const) {
      expect(duration(seconds)).toBe(text);
    }
  });

  test("places are told by their ends", () => {
    expect(place(idle)).toEqual({ short: "recordings", full: "/home/r/recordings" });
    expect(place({ ...idle, name: "a.part2" })).toEqual({ short: "recordings/a.part2", full: "/home/r/recordings/a.part2" });
  });

  test("words", () => {
    expect(words(idle)).toBe("not recording");
    expect(words({ ...idle, on: true })).toBe("recording");
    expect(words({ ...idle, name: "a", finishing: true })).toBe("writing the last frames");
    expect(words({ ...idle, name: "a" })).toBe("recorded");
    expect(words({ ...idle, name: "a", trouble: "no space left" })).toBe("ended by itself");
  });
});
