import { expect, test } from "vitest";
import type { TeamRobot } from "../link/monitor_api";
import { clock_words, columns, pose_words, presence_words, table_csv } from "./columns";
import { pose, robot } from "./testing";

const text = (key: string, of: TeamRobot): string => columns.find((column) => column.key === key)!.text(of);

test("what is not known is a dash, never a zero", () => {
  const unknown = robot(1, { team: "unknown", role: "", action: "", planning_state: "", latency: 0, message_age: null, loss: null, clock_offset: null }, null);
  for (const key of ["team", "role", "action", "planning_state", "pose", "latency", "message_age", "loss", "clock_offset"]) expect(text(key, unknown), key).toBe("–");
  expect(text("loss", robot(1, { loss: 0 }))).toBe("0.0");
  expect(text("withheld", robot(1, { withheld: 0 }))).toBe("0");
  expect(text("frame_rate", robot(1, { presence: "gone" })), "nobody knows what it sees now").toBe("–");
});

test("numbers are in the units of their titles", () => {
  const one = robot(3);
  expect(["latency", "message_age", "bytes_per_second", "loss", "frame_rate"].map((key) => text(key, one))).toEqual(["21", "4", "41.2", "1.2", "30.0"]);
  expect(text("withheld", robot(1, { withheld: 12345 }))).toBe("12\u202f345");
});

test("clocks: milliseconds of a net, seconds and more of one that was never set, zero without a sign", () => {
  expect([0, 0.0007, -0.0028, 0.123, -0.9991, 598.24, -3, null].map(clock_words)).toEqual(["0.0 ms", "+0.7 ms", "−2.8 ms", "+123 ms", "−999 ms", "+9:58 min", "−3.0 s", "–"]);
});

test("poses say their kind, their age, and that they may be mirrored", () => {
  expect(pose_words(robot(1, { pose_kind: "two_lines", pose_age: 0.31 }))).toBe("two lines, 0.3 s");
  expect(pose_words(robot(1, { pose_kind: "one_line", pose_age: 2 }, { ...pose(1, 0), mirror: true }))).toBe("one line, mirrored?, 2.0 s");
  expect(pose_words(robot(1, { pose_kind: "start", pose_age: null }))).toBe("start");
});

test("how long is only told of who is silent", () => {
  expect(presence_words({ presence: "here", age: 0.03 })).toBe("here");
  expect(presence_words({ presence: "stale", age: 2.31 })).toBe("stale 2.3 s");
  expect(presence_words({ presence: "gone", age: 42 })).toBe("gone 42 s");
});

test("every column has room for its title, and a place of its own", () => {
  expect(new Set(columns.map(({ key }) => key)).size).toBe(columns.length);
  for (const { title, width_em } of columns) expect(width_em, title).toBeGreaterThanOrEqual(0.55 * title.length);
  expect(columns[columns.length - 1]!.key, "the widest words come last, where they push nothing aside").toBe("troubles");
});

test("the CSV has a line for each robot and as many cells in each; formulas are none", () => {
  const lines = table_csv(1764.5, [robot(1, { troubles: ['two senders, "A" and "B"', "late"] }), robot(2, { role: "=1+1" }, null)]).split("\r\n");
  expect(lines).toHaveLength(4);
  const cells = (line: string): string[] => line.match(/("([^"]|"")*"|[^,]*)(,|$)/g)!.slice(0, -1);
  const head = lines[0]!.split(",");
  expect(head.slice(0, 2)).toEqual(["t_s", "id"]);
  for (const line of lines.slice(1, 3)) expect(cells(line).length === head.length || cells(line).length === head.length - 1, line).toBe(true);
  expect(lines[1]).toContain('"two senders, ""A"" and ""B""; late"');
  expect(lines[2]).toContain("'=1+1");
  expect(lines[2], "no pose, no place").toMatch(/,,,,,?$/);
});
