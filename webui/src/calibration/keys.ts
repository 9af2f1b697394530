import type { CalibrationSession } from "./calibration_session";

/// What keys do, as the page's help tells it.
export const key_help: readonly (readonly [string, string])[] = [
  ["c", "capture now"], ["s", "solve, and capture no more by themselves"], ["Ctrl+S", "save and use"], ["f", "large, and small again"], ["space", "freeze the picture"],
];

/// Keys of the whole page; returns whether the key was one of them.
export function press(session: CalibrationSession, event: KeyboardEvent): boolean {
  const key = event.key.toLowerCase();
  if (event.altKey || event.repeat) return false;
  if (event.ctrlKey || event.metaKey) {
    if (key !== "s") return false;
    void session.save();
    return true;
  }
  if (event.target instanceof HTMLElement && event.target.closest('input:not([type="checkbox"], [type="radio"]), textarea, select, [contenteditable]') !== null) return false;
  switch (key) {
    case "c": void session.capture(); return true;
    case "s": void session.solve(); return true;
    case "f": document.querySelector<HTMLElement>('[data-show="full"]')?.click(); return true;
    default: return false;
  }
}
