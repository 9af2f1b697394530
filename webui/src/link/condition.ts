import type { ChannelState } from "./channel";

/// How things stand, in words that a person reads at a glance.
export interface Condition {
  readonly tone: "good" | "warning" | "bad";
  readonly text: string;
}

export interface Signs {
  scene: ChannelState;
  frozen: boolean;
  ended: boolean;
  /// Why the server's state could not be had; empty when it could.
  trouble: string;
  /// Since the last scene, [ms]; null before the first.
  silence_ms: number | null;
  now: number;
}

/// So long without a scene is worth a word, [ms].
export const silence_limit_ms = 1500;

/// The worst comes first: numbers on the page are only "live" when nothing else is to be said.
///
/// what  comes while all is well
export function condition_of(signs: Signs, what = "scene"): Condition {
  if (signs.trouble.startsWith("not admitted")) return { tone: "bad", text: signs.trouble };
  if (signs.scene.kind === "waiting") {
    const seconds = Math.max(Math.ceil((signs.scene.until - signs.now) / 1000), 0);
    return { tone: "bad", text: `connection lost, next try in ${seconds} s` };
  }
  if (signs.scene.kind !== "open") {
    return signs.silence_ms === null ? { tone: "warning", text: "connecting" } : { tone: "bad", text: "connection lost, connecting" };
  }
  if (signs.ended) return { tone: "warning", text: "source ended" };
  if (signs.silence_ms === null) return { tone: "warning", text: `connected, no ${what} yet` };
  if (signs.silence_ms > silence_limit_ms) return { tone: "warning", text: `no ${what} for ${(signs.silence_ms / 1000).toFixed(0)} s` };
  if (signs.frozen) return { tone: "warning", text: "frozen" };
  return { tone: "good", text: "live" };
}
