import { space_key, zoom_field } from "./field_pointer";
import type { MonitorSession } from "./monitor_session";

/// What keys do, as the page's help tells it.
export const key_help: readonly (readonly [string, string])[] = [
  ["space", "pause, play"], ["← →", "one picture back, on"], ["Shift+← →", "one second"], ["Home, End", "begin; live, or the log's end"], ["l", "live"], ["< >", "slower, faster"],
  ["1 … 9", "choose a robot"], ["n p", "next robot, the one before"], ["Escape", "end measuring, close the picture"], ["m", "measure with one finger"],
  ["+ − f", "zoom in, out, whole field"], ["wheel; space or middle button", "zoom; move the field"], ["drag on the field", "measure"], ["s", "field as PNG"], ["c", "table as CSV"],
];

const seconds_of_shift = 1;

function is_typing(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.closest("input:not([type=range], [type=checkbox]), textarea, select, [contenteditable]") !== null;
}

function click(show: string): void {
  document.querySelector<HTMLElement>(`[data-show="${show}"]`)?.click();
}

/// Keys of the whole page; returns whether the key was one of them.
export function press(session: MonitorSession, event: KeyboardEvent): boolean {
  if (event.altKey || event.ctrlKey || event.metaKey || is_typing(event.target)) return false;
  const canvas = document.querySelector<HTMLCanvasElement>('[data-show="field"]');
  const zoom = (factor: number): boolean => {
    if (canvas !== null) zoom_field(session, canvas, factor);
    return true;
  };
  const way = event.key === "ArrowLeft" ? -1 : event.key === "ArrowRight" ? 1 : 0;
  if (way !== 0) {
    if (event.shiftKey) session.move(way * seconds_of_shift);
    else session.step(way);
    return true;
  }
  if (/^[1-9]$/.test(event.key)) {
    session.select(Number(event.key));
    return true;
  }
  switch (event.key.length === 1 ? event.key.toLowerCase() : event.key) {
    case " ":
      // Buttons and boxes have a use of their own for it.
      if (event.target instanceof HTMLElement && event.target.closest("button, a, summary, input[type=checkbox]") !== null) return false;
      if (!event.repeat) {
        space_key.is_held = true;
        space_key.was_used = false;
      }
      return true;
    case "Home": session.to_begin(); return true;
    case "End": case "l": session.to_end(); return true;
    case "<": session.change_speed(false); return true;
    case ">": session.change_speed(true); return true;
    case "n": session.select_next(1); return true;
    case "p": session.select_next(-1); return true;
    case "m": session.measuring.set(!session.measuring.value); return true;
    case "+": case "=": return zoom(1.25);
    case "-": return zoom(0.8);
    case "f": session.camera.set(null); return true;
    case "s": click("save-field"); return true;
    case "c": click("save-table"); return true;
    case "Escape": return session.cancel();
    default: return false;
  }
}

/// The space key plays and pauses when it is let go and moved nothing meanwhile.
export function release(session: MonitorSession, event: KeyboardEvent): void {
  if (event.key !== " " || !space_key.is_held) return;
  space_key.is_held = false;
  if (!space_key.was_used) session.toggle_play();
}
