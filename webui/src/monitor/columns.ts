import { count, degrees, fixed, missing } from "../format";
import type { TeamRobot } from "../link/monitor_api";
import { duration_words } from "./moment";

/// A column of the state table. To add one: describe it here; the table, the CSV and their order follow.
export interface Column {
  readonly key: string;
  readonly title: string;
  /// Of the numbers in it; none: words.
  readonly unit?: string;
  /// What it means, for whoever points at its title.
  readonly hint: string;
  /// Of the table, in the size of its letters: columns do not jump when their content changes.
  readonly width_em: number;
  readonly is_number: boolean;
  /// As a person reads it; "–": not known.
  readonly text: (robot: TeamRobot) => string;
  /// As a program reads it; null: not known.
  readonly value: (robot: TeamRobot) => string | number | null;
  /// Is it worth a look?
  readonly tone?: (robot: TeamRobot) => "warning" | "bad" | "faint" | "";
}

/// Shares and times beyond which somebody should look: a percent is lost in any hall, a tenth is felt in a game; a clock as far off is among the server's troubles.
const much_loss = 0.1;
const late_s = 0.15;
const wrong_clock_s = 1;

function number_column(key: string, title: string, unit: string, width_em: number, hint: string, value: (robot: TeamRobot) => number | null, digits: number,
                       tone?: (robot: TeamRobot) => "warning" | "bad" | ""): Column {
  const text = (robot: TeamRobot): string => {
    const number = value(robot);
    return number === null ? missing : digits === 0 ? whole(number) : fixed(number, digits);
  };
  return { key, title, unit, hint, width_em, is_number: true, text, value: (robot) => value(robot), ...(tone === undefined ? {} : { tone }) };
}

function whole(number: number): string {
  return (number <= -0.5 ? "−" : "") + count(Math.round(Math.abs(number)));
}

/// Milliseconds are what clocks of one net differ by; a clock that was never set is told in seconds or more.
export function clock_words(offset: number | null): string {
  if (offset === null || !Number.isFinite(offset)) return missing;
  const sign = offset < 0 ? "−" : "+";
  const size = Math.abs(offset);
  if (size < 0.9995) return `${Math.round(size * 1000) === 0 ? "" : sign}${fixed(size * 1000, size < 0.00995 ? 1 : 0)} ms`;
  return `${sign}${duration_words(size)}`;
}

export function pose_words({ pose_kind, pose_age, scene: { pose } }: TeamRobot): string {
  if (pose_kind === "none") return missing;
  const mirrored = pose?.mirror ? ", mirrored?" : "";
  return `${pose_kind.replace("_", " ")}${mirrored}${pose_age === null ? "" : `, ${duration_words(pose_age)}`}`;
}

export function presence_words({ presence, age }: Pick<TeamRobot, "presence" | "age">): string {
  return presence === "here" ? presence : `${presence} ${duration_words(age)}`;
}

const is_here = ({ presence }: TeamRobot): boolean => presence === "here";
const word = (text: string): string => (text === "" ? missing : text.replace(/_/g, " "));

/// Of the robot that is told, "of late" and "lately" as the server judges.
export const columns: readonly Column[] = [
  { key: "id", title: "robot", hint: "number", width_em: 4, is_number: true, text: ({ id }) => String(id), value: ({ id }) => id },
  { key: "team", title: "team", hint: "color of its marker", width_em: 5.9, is_number: false, text: ({ team }) => (team === "unknown" ? missing : team), value: ({ team }) => team },
  { key: "presence", title: "presence", hint: "stale: silent for more than 1 s; gone: for more than 5 s", width_em: 7.2, is_number: false, text: presence_words,
    value: ({ presence }) => presence, tone: ({ presence }) => (presence === "gone" ? "bad" : presence === "stale" ? "warning" : "") },
  { key: "role", title: "role", hint: "as it says", width_em: 7.4, is_number: false, text: ({ role }) => word(role), value: ({ role }) => role || null },
  { key: "action", title: "action", hint: "as it says", width_em: 9.2, is_number: false, text: ({ action }) => word(action), value: ({ action }) => action || null },
  { key: "planning_state", title: "planning", hint: "state of its planning, as it says", width_em: 7.2, is_number: false, text: ({ planning_state }) => word(planning_state),
    value: ({ planning_state }) => planning_state || null },
  { key: "pose", title: "pose", hint: "how it was found, and for how long there was no absolute fix", width_em: 15.4, is_number: false, text: pose_words,
    value: ({ pose_kind }) => pose_kind, tone: (robot) => (robot.pose_kind === "none" ? "bad" : robot.scene.pose?.mirror || (robot.pose_age ?? 0) > 2 ? "warning" : "") },
  number_column("frame_rate", "images", "1/s", 4.6, "it sees a second, as it says", (robot) => (is_here(robot) ? robot.frame_rate : null), 1),
  number_column("latency", "latency", "ms", 4.8, "from an image to what was seen in it, as it says", ({ latency }) => (latency === 0 ? null : latency * 1000), 0,
                ({ latency }) => (latency > late_s ? "warning" : "")),
  number_column("message_age", "message", "ms old", 5.6, "from the image to here, of the newest message, as far as clocks agree", ({ message_age }) => (message_age === null ? null : message_age * 1000), 0,
                ({ message_age }) => ((message_age ?? 0) > late_s ? "warning" : "")),
  number_column("messages_per_second", "heard", "1/s", 4, "messages that came here, a second", (robot) => robot.messages_per_second, 1),
  number_column("bytes_per_second", "data", "kB/s", 4, "that came here", (robot) => robot.bytes_per_second / 1000, 1),
  number_column("loss", "loss", "%", 4.4, "share of its messages that did not come here lately", ({ loss }) => (loss === null ? null : loss * 100), 1,
                ({ loss }) => ((loss ?? 0) > much_loss ? "bad" : "")),
  number_column("refused", "refused", "", 4.8, "messages in its name that were not believed", ({ refused }) => refused, 0, ({ refused }) => (refused > 0 ? "warning" : "")),
  number_column("withheld", "withheld", "", 5.2, "messages that it did not send to stay within its budget, as it says", ({ withheld }) => withheld, 0),
  { key: "clock_offset", title: "clock", unit: "", hint: "its clock before ours, at least", width_em: 6.6, is_number: true, text: ({ clock_offset }) => clock_words(clock_offset),
    value: ({ clock_offset }) => clock_offset, tone: ({ clock_offset }) => (Math.abs(clock_offset ?? 0) > wrong_clock_s ? "warning" : "") },
  { key: "troubles", title: "troubles", hint: "in words", width_em: 14, is_number: false, text: ({ troubles }) => troubles.join("; "), value: ({ troubles }) => troubles.join("; "), tone: () => "bad" },
];

/// What the plan shows and the table does not.
const more_values: readonly { key: string; value: (robot: TeamRobot) => string | number | boolean | null }[] = [
  { key: "age_s", value: ({ age }) => age },
  { key: "pose_age_s", value: ({ pose_age }) => pose_age },
  { key: "x_m", value: ({ scene: { pose } }) => pose?.x ?? null },
  { key: "y_m", value: ({ scene: { pose } }) => pose?.y ?? null },
  { key: "theta_rad", value: ({ scene: { pose } }) => pose?.theta ?? null },
  { key: "mirrored", value: ({ scene: { pose } }) => pose?.mirror ?? null },
];

const csv_units: Readonly<Record<string, string>> = { frame_rate: "hz", latency: "ms", message_age: "ms", bytes_per_second: "kB_s", loss: "percent", clock_offset: "s" };

/// A text that another program would run as a formula, or take for two cells, is quoted. source: RFC 4180; for formulas, the advice of OWASP on CSV injection
function csv_cell(value: string | number | boolean | null): string {
  if (value === null) return "";
  if (typeof value !== "string") return String(value);
  const harmless = /^[=+\-@\t\r]/.test(value) ? `'${value}` : value;
  return /[",\n\r;]/.test(harmless) ? `"${harmless.replace(/"/g, '""')}"` : harmless;
}

/// The whole table and the poses, one line a robot. t  of the picture, [s]
export function table_csv(t: number, robots: readonly TeamRobot[]): string {
  const head = ["t_s", ...columns.map(({ key }) => (csv_units[key] === undefined ? key : `${key}_${csv_units[key]}`)), ...more_values.map(({ key }) => key)];
  const lines = robots.map((robot) => [t, ...columns.map(({ value }) => value(robot)), ...more_values.map(({ value }) => value(robot))]);
  return [head, ...lines].map((line) => line.map(csv_cell).join(",")).join("\r\n") + "\r\n";
}

/// Where it stands, for those who cannot see the field.
export function place_of_robot({ scene: { pose } }: TeamRobot): string {
  return pose === null ? "pose unknown" : `at ${fixed(pose.x, 1)}, ${fixed(pose.y, 1)} m, ${degrees(pose.theta, 0)}`;
}
