import { expect, test } from "vitest";
import { most_targets, TargetEditor } from "./target_editor";

function editor(accepts = true): { editor: TargetEditor; sent: (readonly string[])[] } {
  const sent: (readonly string[])[] = [];
  const made = new TargetEditor(async (targets) => {
    sent.push(targets);
    return accepts;
  });
  made.told(["dots:7x7:0.04:0.01"]);
  return { editor: made, sent };
}

test("what the server has is shown, but does not disturb who types", () => {
  const { editor: targets } = editor();
  expect(targets.texts).toEqual(["dots:7x7:0.04:0.01"]);
  targets.edit(0, { columns: "9" });
  targets.told(["checker:9x6:0.025"]);
  expect(targets.texts).toEqual(["dots:9x7:0.04:0.01"]);
  targets.revert();
  expect(targets.texts).toEqual(["checker:9x6:0.025"]);
  targets.told([]);
  expect(targets.texts, "a server without targets leaves what is there to begin with").toEqual(["checker:9x6:0.025"]);
});

test("only targets are sent, all of them, and only when they are others", async () => {
  const { editor: targets, sent } = editor();
  expect(await targets.commit()).toBe(true);
  targets.edit(0, { pitch: "40" });
  expect(await targets.commit()).toBe(false);
  expect(targets.why(0)).toMatch(/lengths are in meters/);
  expect(sent).toEqual([]);
  targets.edit(0, { pitch: "0.05" });
  targets.add();
  expect(targets.why(1)).toBe("is named twice");
  expect(targets.texts).toBeNull();
  targets.edit(1, { kind: "checker", columns: "9", rows: "6" });
  expect(await targets.commit()).toBe(true);
  expect(sent).toEqual([["dots:7x7:0.05:0.01", "checker:9x6:0.05"]]);
  expect(targets.view.value.is_edited).toBe(false);
});

test("what is refused stays to be corrected", async () => {
  const { editor: targets } = editor(false);
  targets.edit(0, { columns: "9" });
  expect(await targets.commit()).toBe(false);
  expect(targets.view.value.is_edited).toBe(true);
  expect(targets.texts).toEqual(["dots:9x7:0.04:0.01"]);
});

test("there is always one, and never more than the server takes", () => {
  const { editor: targets } = editor();
  targets.remove(0);
  expect(targets.view.value.rows.length).toBe(1);
  for (let n = 0; n < 9; ++n) targets.add();
  expect(targets.view.value.rows.length).toBe(most_targets);
});
