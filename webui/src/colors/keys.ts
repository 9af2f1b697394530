import { class_of_key, type ColorsSession, modes } from "./colors_session";

/// What keys do, as the page's help tells it.
export const key_help: readonly (readonly [string, string])[] = [
  ["0 … 8", "class"], ["p r b s", "polygon, rectangle, brush, select"], ["[ ]", "smaller, larger brush"], ["u, Ctrl+Z", "undo"],
  ["Ctrl+Shift+Z, Ctrl+Y", "redo"], ["Enter", "close the polygon"], ["Backspace", "last corner back"], ["Escape", "drop what is begun"],
  ["n, Delete", "next sample, delete it"], ["k, l", "keep live picture, show live"], ["space", "freeze"], ["v", "next view"],
  ["+ − f", "zoom in, out, whole picture"], ["arrows, Enter", "draw without a pointer, on the picture"], ["Ctrl+S", "save and use"],
];

function is_typing(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.closest("input:not([type=range], [type=checkbox], [type=radio]), textarea, select, [contenteditable]") !== null;
}

/// Keys of the whole page; returns whether the key was one of them.
export function press(colors: ColorsSession, event: KeyboardEvent): boolean {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (event.altKey) return false;
  if (event.ctrlKey || event.metaKey) {
    if (key === "s") {
      document.querySelector<HTMLElement>('[data-show="save"]')?.click();
      return true;
    }
    if (is_typing(event.target)) return false;
    if (key === "z" && event.shiftKey) colors.redo();
    else if (key === "z") colors.undo();
    else if (key === "y") colors.redo();
    else return false;
    return true;
  }
  if (is_typing(event.target)) return false;
  const color = class_of_key(event.key);
  if (color !== null) {
    colors.choose(color);
    return true;
  }
  const on_button = event.target instanceof HTMLElement && event.target.closest("button, a, summary, label") !== null;
  switch (key) {
    case "u": colors.undo(); return true;
    case "p": colors.choose_tool("polygon"); return true;
    case "r": colors.choose_tool("rectangle"); return true;
    case "b": colors.choose_tool("brush"); return true;
    case "s": colors.choose_tool("select"); return true;
    case "[": colors.change_radius(-1); return true;
    case "]": colors.change_radius(1); return true;
    case "k": void colors.keep(); return true;
    case "l": colors.look_at(null); return true;
    case "n": colors.select_next(); return true;
    case "v": colors.mode.set(modes[(modes.indexOf(colors.mode.value) + 1) % modes.length]!); return true;
    case "Escape": colors.cancel(); return true;
    case "Backspace":
      if (colors.begun.value !== null) colors.take_corner_back();
      else colors.remove(colors.selected.value);
      return true;
    case "Delete": colors.remove(colors.selected.value); return true;
    case "Enter":
      if (on_button || colors.begun.value?.tool !== "polygon") return false;
      colors.finish(event.timeStamp);
      return true;
    default: return false;
  }
}
