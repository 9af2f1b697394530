import { apply, inverse } from "../canvas/transform";
import type { Point } from "../scene";
import { canvas_from_camera, panned, zoomed } from "./field_camera";
import { robot_at, team_area } from "./field_drawing";
import type { FieldPainter } from "./field_painter";
import type { MonitorSession } from "./monitor_session";

/// Less is a click and no drag, [px of the page].
const least_drag_px = 4;

/// The space key, held, moves the field; that it did so is remembered, because a space key that did nothing else plays and pauses.
export const space_key = { is_held: false, was_used: false };

type Gesture = { readonly kind: "measure"; readonly from: Point; moved: boolean } | { readonly kind: "pan" };

/// What pointers do on the field: a click chooses a robot, a drag measures; with space, the middle button or two fingers it moves the field, the wheel zooms.
///
/// hovered  the place under the pointer, field frame; null when it left
export function follow_pointer(painter: FieldPainter, session: MonitorSession, hovered: (place: Point | null) => void): () => void {
  const { canvas } = painter;
  const stop = new AbortController();
  const options = { signal: stop.signal };
  const down = new Map<number, Point>();
  let gesture: Gesture | null = null;

  const area = () => team_area(session.content());
  const at = (event: { clientX: number; clientY: number }): Point => {
    const box = canvas.getBoundingClientRect();
    return [((event.clientX - box.left) * canvas.width) / box.width, ((event.clientY - box.top) * canvas.height) / box.height];
  };
  const on_field = (point: Point): Point => apply(inverse(canvas_from_camera(session.camera.value, area(), canvas)), point);
  const pan = (by: Point): void => session.camera.set(panned(session.camera.value, by, area(), canvas));
  const zoom = (factor: number, anchor: Point): void => session.camera.set(zoomed(session.camera.value, factor, anchor, area(), canvas));

  canvas.addEventListener("pointerdown", (event) => {
    const point = at(event);
    down.set(event.pointerId, point);
    if (down.size === 2) gesture = { kind: "pan" };
    else if (event.button === 1 || (event.button === 0 && space_key.is_held)) {
      gesture = { kind: "pan" };
      space_key.was_used = true;
    } else if (event.button === 0) gesture = { kind: "measure", from: point, moved: false };
    if (event.button === 1) event.preventDefault();   // no scrolling by itself
    if (gesture !== null) canvas.setPointerCapture(event.pointerId);
  }, options);

  canvas.addEventListener("pointermove", (event) => {
    const point = at(event);
    hovered(on_field(point));
    const before = down.get(event.pointerId);
    if (before === undefined) {
      canvas.style.cursor = space_key.is_held ? "grab" : robot_at(session.content(), point, canvas, painter.density) === null ? "" : "pointer";
      return;
    }
    down.set(event.pointerId, point);
    if (gesture?.kind === "pan") {
      const other = [...down].find(([id]) => id !== event.pointerId)?.[1];
      if (other === undefined) return pan([point[0] - before[0], point[1] - before[1]]);
      const [was, is] = [Math.hypot(before[0] - other[0], before[1] - other[1]), Math.hypot(point[0] - other[0], point[1] - other[1])];
      pan([(point[0] - before[0]) / 2, (point[1] - before[1]) / 2]);
      if (was > 0 && is > 0) zoom(is / was, [(point[0] + other[0]) / 2, (point[1] + other[1]) / 2]);
    } else if (gesture?.kind === "measure") {
      if (event.pointerType === "touch" && !session.measuring.value) return;
      gesture.moved ||= Math.hypot(point[0] - gesture.from[0], point[1] - gesture.from[1]) >= least_drag_px * painter.density;
      if (gesture.moved) session.measure.set({ from: on_field(gesture.from), to: on_field(point) });
    }
  }, options);

  const up = (event: PointerEvent): void => {
    down.delete(event.pointerId);
    if (gesture?.kind === "measure" && event.type === "pointerup" && !gesture.moved) {
      const point = at(event);
      const is_click = Math.hypot(point[0] - gesture.from[0], point[1] - gesture.from[1]) < 3 * least_drag_px * painter.density;
      const id = is_click ? robot_at(session.content(), point, canvas, painter.density) : null;
      if (id !== null) session.select(id);
      else session.measure.set(null);
    }
    if (down.size === 0) gesture = null;
  };
  canvas.addEventListener("pointerup", up, options);
  canvas.addEventListener("pointercancel", up, options);
  canvas.addEventListener("pointerleave", () => hovered(null), options);

  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
    zoom(Math.exp(-0.0015 * lines * Math.max(-400, Math.min(event.deltaY, 400))), at(event));
  }, { ...options, passive: false });
  // One finger scrolls the page, two are for the field.
  const keep_two = (event: TouchEvent): void => {
    if (event.touches.length > 1 || session.measuring.value) event.preventDefault();
  };
  canvas.addEventListener("touchstart", keep_two, { ...options, passive: false });
  canvas.addEventListener("touchmove", keep_two, { ...options, passive: false });
  return () => stop.abort();
}

/// From the middle of the canvas, for keys and buttons.
export function zoom_field(session: MonitorSession, canvas: HTMLCanvasElement, factor: number): void {
  session.camera.set(zoomed(session.camera.value, factor, [canvas.width / 2, canvas.height / 2], team_area(session.content()), canvas));
}

/// A robot's place on the page; null when it has none.
export function page_place(session: MonitorSession, canvas: HTMLCanvasElement, id: number): Point | null {
  const pose = session.feed.drawn.value?.robots.find((robot) => robot.id === id)?.scene.pose;
  if (!pose) return null;
  const [x, y] = apply(canvas_from_camera(session.camera.value, team_area(session.content()), canvas), [pose.x, pose.y]);
  const box = canvas.getBoundingClientRect();
  return [box.left + (x * box.width) / canvas.width, box.top + (y * box.height) / canvas.height];
}
