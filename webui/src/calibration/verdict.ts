import type { CalibrationView } from "./calibration_model";

/// good: captured; wait: a target is there, but not yet captured; none: there is no target; idle: nothing is looked for
export type Tone = "good" | "wait" | "none" | "idle";

export interface Verdict {
  readonly text: string;
  /// More of it, for those who are near enough; may be empty.
  readonly detail: string;
  readonly tone: Tone;
}

/// What is to be read from where the target is held: few words. The server says the short of it before a colon.
export function verdict_of(view: CalibrationView): Verdict {
  const { text, tone } = whole_verdict(view);
  const colon = text.indexOf(": ");
  return colon < 0 ? { text, detail: "", tone } : { text: text.slice(0, colon), detail: text.slice(colon + 2), tone };
}

function whole_verdict({ calibration, captured, trouble }: CalibrationView): { text: string; tone: Tone } {
  if (trouble !== "") return { text: "no answer from the robot", tone: "idle" };
  if (calibration === null) return { text: "waiting for the robot", tone: "idle" };
  if (captured !== null) return { text: `view ${captured} captured`, tone: "good" };
  if (calibration.is_solving) return { text: "working the camera out", tone: "idle" };
  if (!calibration.is_on) return { text: "not begun", tone: "idle" };
  const { now } = calibration;
  if (now === null) return { text: "waiting for a frame", tone: "idle" };
  return { text: now.verdict, tone: now.is_captured ? "good" : now.target === null ? "none" : "wait" };
}

/// Why the camera cannot be worked out now; empty when it can.
export function why_not_solved({ calibration, pending }: CalibrationView): string {
  if (calibration === null) return "the robot has not answered yet";
  if (calibration.is_solving || pending.includes("solve")) return "it is being worked out";
  return calibration.views.length === 0 ? "there are no views yet" : "";
}

/// Why the result cannot be saved now; empty when it can.
export function why_not_kept({ calibration, pending }: CalibrationView): string {
  if (calibration === null) return "the robot has not answered yet";
  if (calibration.file.refusal !== "") return calibration.file.refusal;
  if (calibration.is_solving) return "it is being worked out";
  if (calibration.result === null) return "there is no result yet";
  if (pending.includes("save")) return "it is being saved";
  return calibration.file.is_saved ? "the file has this result" : "";
}

/// A value with as many digits as its standard deviation leaves meaning to, which itself has two.
export function with_sigma(value: number, sigma: number): { value: string; sigma: string } {
  if (!(sigma > 0) || !Number.isFinite(sigma)) return { value: plain(value.toPrecision(6)), sigma: "?" };
  const digits = Math.min(Math.max(1 - Math.floor(Math.log10(sigma)), 0), 9);
  return { value: plain(value.toFixed(digits)), sigma: sigma.toFixed(digits) };
}

function plain(text: string): string {
  return text.replace("-", "−");
}
