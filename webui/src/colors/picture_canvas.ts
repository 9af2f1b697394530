import { follow_size } from "../canvas/follow_size";
import { apply, inverse } from "../canvas/transform";
import type { YuvFrame } from "../link/frame_bytes";
import type { Point } from "../scene";
import type { Classifier } from "./classify";
import type { ColorsSession } from "./colors_session";
import { corner_reach } from "./drawing";
import { FramePainter } from "./frame_painter";
import { pixel_at } from "./shapes";
import { ShapePen } from "./shape_pen";
import { canvas_from_image, type ImageView, panned, showing, whole_image, zoomed } from "./view_transform";

/// A pointer that moved less than this has clicked. [px of the page]
const click_reach = 6;

interface Finger {
  readonly down: Point;
  at: Point;
  /// It moves the picture, rather than drawing.
  pans: boolean;
}

/// The picture with its samples, and what pointers do on it. Drawn when the screen is ready.
export class PictureCanvas {
  private readonly context: CanvasRenderingContext2D;
  private readonly painter = new FramePainter();
  private readonly fingers = new Map<number, Finger>();
  private hover: Point | null = null;
  private requested = 0;
  private measured: Classifier | null = null;
  private shape = "";
  private readonly ends: (() => void)[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly colors: ColorsSession,
  ) {
    this.context = canvas.getContext("2d", { alpha: false })!;
    const { pictures, training } = colors;
    const redraw = (): void => this.request();
    // What came of a sample is awaited: it is drawn at once, before anything else on the page.
    this.ends.push(training.view.subscribe(() => (training.view.value.classifier === this.measured ? this.request() : this.draw())));
    for (const source of [pictures.live, pictures.shown, pictures.loaded, colors.mode, colors.opacity, colors.view, colors.begun,
                          colors.selected, colors.cursor, colors.tool, colors.radius]) {
      this.ends.push(source.subscribe(redraw));
    }
    this.ends.push(follow_size(canvas, () => this.density, () => this.draw()));
    this.listen("pointerdown", (event) => this.down(event));
    this.listen("pointermove", (event) => this.move(event));
    this.listen("pointerup", (event) => this.up(event));
    this.listen("pointercancel", (event) => this.lost(event));
    this.listen("pointerleave", () => this.leave());
    this.listen("wheel", (event) => this.wheel(event), { passive: false });
    this.listen("contextmenu", (event) => event.preventDefault());
    this.listen("keydown", (event) => this.key(event));
    redraw();
  }

  end(): void {
    cancelAnimationFrame(this.requested);
    for (const end of this.ends) end();
  }

  /// The middle stays.
  zoom(factor: number): void {
    this.zoom_at(factor, [this.canvas.width / 2, this.canvas.height / 2]);
  }

  fit(): void {
    this.colors.view.set(null);
  }

  private listen<K extends keyof HTMLElementEventMap>(name: K, call: (event: HTMLElementEventMap[K]) => void, options?: AddEventListenerOptions): void {
    this.canvas.addEventListener(name, call, options);
    this.ends.push(() => this.canvas.removeEventListener(name, call, options));
  }

  private get density(): number {
    return Math.max(1, Math.min(devicePixelRatio, 2));
  }

  private get view(): ImageView | null {
    const { frame } = this.colors.pictures;
    return frame === null ? null : (this.colors.view.value ?? whole_image(frame));
  }

  private request(): void {
    if (this.requested !== 0) return;
    this.requested = requestAnimationFrame(() => {
      this.requested = 0;
      this.draw();
    });
  }

  private draw(): void {
    const { colors, canvas, context, painter } = this;
    const { frame } = colors.pictures;
    const { training } = colors;
    const { classifier, in_use, drawn_at } = training.view.value;
    context.imageSmoothingEnabled = false;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = "#0c1218";
    context.fillRect(0, 0, canvas.width, canvas.height);
    if (frame === null) return;
    this.fit_to(frame);
    painter.paint({ frame, mode: colors.mode.value, opacity: colors.opacity.value, classifier, in_use });
    const to_canvas = canvas_from_image(this.view!, frame, canvas);
    context.imageSmoothingEnabled = to_canvas.a < 1;
    context.drawImage(painter.canvas, to_canvas.e - to_canvas.a / 2, to_canvas.f - to_canvas.a / 2, frame.width * to_canvas.a, frame.height * to_canvas.a);
    this.draw_samples();
    this.tell_changed(painter.changed, frame.y.length);
    canvas.dataset["version"] = String(training.view.value.result?.version ?? "");
    canvas.dataset["frame"] = String(frame.frame);
    // From the event that changed the samples to the picture that shows what came of it.
    if (classifier !== this.measured && classifier !== null) {
      this.measured = classifier;
      if (drawn_at !== null) performance.measure("resegmented", { start: drawn_at, end: performance.now() });
    }
  }

  /// The canvas has the picture's shape; the observer of its size draws again.
  private fit_to({ width, height }: YuvFrame): void {
    const shape = `${width} / ${height}`;
    if (this.shape === shape) return;
    if (this.shape !== "") this.colors.view.set(null);   // what was zoomed to is elsewhere in a picture of another size
    this.shape = shape;
    this.canvas.style.aspectRatio = shape;
  }

  private draw_samples(): void {
    const { colors, context } = this;
    const frame = colors.pictures.frame!;
    const pen = new ShapePen(context, canvas_from_image(this.view!, frame, this.canvas), this.density);
    const color = colors.training.view.value.color;
    const selected = colors.selected.value;
    for (const sample of colors.training.draft.samples) {
      if (sample.image === colors.pictures.image) pen.shape(sample, sample.class, sample === selected);
    }
    const begun = colors.begun.value;
    const pointer = colors.cursor.value ?? this.hover;
    if (begun !== null) pen.begun(begun, pointer, color, frame);
    if (colors.tool.value === "brush" && pointer !== null) pen.brush(pointer, colors.radius.value, color);
    if (colors.cursor.value !== null) pen.cross(colors.cursor.value);
  }

  private tell_changed(pixels: number | null, of: number): void {
    const before = this.colors.changed.value;
    if (pixels === null ? before === null : before?.pixels === pixels && before.of === of) return;
    this.colors.changed.set(pixels === null ? null : { pixels, of });
  }

  // What pointers do. Points of events are on the page, those of `canvas_point` in pixels of the canvas.

  private canvas_point(event: MouseEvent): Point {
    const box = this.canvas.getBoundingClientRect();
    return [((event.clientX - box.left) * this.canvas.width) / box.width, ((event.clientY - box.top) * this.canvas.height) / box.height];
  }

  private image_point(at: Point): Point {
    return apply(inverse(canvas_from_image(this.view!, this.colors.pictures.frame!, this.canvas)), at);
  }

  /// So many pixels of the image are one of the page.
  private get image_px(): number {
    return this.density / canvas_from_image(this.view!, this.colors.pictures.frame!, this.canvas).a;
  }

  private down(event: PointerEvent): void {
    if (this.colors.pictures.frame === null) return;
    this.canvas.focus({ preventScroll: true });
    event.preventDefault();
    this.canvas.setPointerCapture(event.pointerId);
    const at = this.canvas_point(event);
    const { tool } = this.colors;
    const finger: Finger = { down: at, at, pans: event.button !== 0 };
    this.fingers.set(event.pointerId, finger);
    this.colors.cursor.set(null);
    if (this.fingers.size > 1) {
      // Two fingers zoom; what the first one began was not meant.
      if (this.colors.begun.value?.tool !== "polygon") this.colors.begun.set(null);
      for (const other of this.fingers.values()) other.pans = true;
      return;
    }
    if (finger.pans) return;
    const point = this.image_point(at);
    if (tool.value === "select") finger.pans = !this.colors.select_at(point, 4 * this.image_px);
    else if (tool.value !== "polygon") this.colors.begin(point);
  }

  private move(event: PointerEvent): void {
    if (this.colors.pictures.frame === null) return;
    const at = this.canvas_point(event);
    const finger = this.fingers.get(event.pointerId);
    this.colors.cursor.set(null);
    this.point_at(at);
    if (finger === undefined) return this.request();
    if (this.fingers.size === 2) this.pinch(finger, at);
    else if (finger.pans || this.pans_polygon(finger, at)) this.pan([at[0] - finger.at[0], at[1] - finger.at[1]]);
    else if (this.colors.begun.value?.tool !== "polygon") {
      for (const part of event.getCoalescedEvents?.() ?? [event]) this.colors.drag(this.image_point(this.canvas_point(part)));
      this.colors.drag(this.image_point(at));
    }
    finger.at = at;
  }

  /// Dragging with the polygon's tool moves the picture; its corners are clicks.
  private pans_polygon(finger: Finger, at: Point): boolean {
    if (this.colors.tool.value !== "polygon" || !this.has_moved(finger, at)) return false;
    finger.pans = true;
    return true;
  }

  private has_moved({ down }: Finger, at: Point): boolean {
    return Math.hypot(at[0] - down[0], at[1] - down[1]) > click_reach * this.density;
  }

  private up(event: PointerEvent): void {
    const finger = this.fingers.get(event.pointerId);
    this.fingers.delete(event.pointerId);
    if (finger === undefined || finger.pans || this.colors.pictures.frame === null) return;
    const point = this.image_point(this.canvas_point(event));
    if (this.colors.tool.value === "polygon") this.colors.corner(point, corner_reach * this.image_px, event.timeStamp);
    else if (this.colors.begun.value !== null) {
      this.colors.drag(point);
      this.colors.finish(event.timeStamp);
    }
  }

  private lost(event: PointerEvent): void {
    if (this.fingers.delete(event.pointerId) && this.colors.begun.value?.tool !== "polygon") this.colors.begun.set(null);
  }

  private leave(): void {
    this.hover = null;
    this.colors.probe.set(null);
    this.request();
  }

  private point_at(at: Point): void {
    const frame = this.colors.pictures.frame!;
    const point = this.image_point(at);
    this.hover = point;
    if (point[0] < -0.5 || point[1] < -0.5 || point[0] >= frame.width - 0.5 || point[1] >= frame.height - 0.5) return this.colors.probe.set(null);
    this.probe(point);
  }

  private probe(point: Point): void {
    const frame = this.colors.pictures.frame!;
    const pixel = pixel_at(point, frame);
    const chroma = pixel[1] * Math.ceil(frame.width / 2) + (pixel[0] >> 1);
    const [y, u, v] = [frame.y[pixel[1] * frame.width + pixel[0]]!, frame.u[chroma]!, frame.v[chroma]!];
    this.colors.probe.set({ at: pixel, y, u, v, label: this.colors.training.view.value.classifier?.label(y, u, v) ?? null });
  }

  private pinch(finger: Finger, at: Point): void {
    const other = [...this.fingers.values()].find((one) => one !== finger)!;
    const before = Math.hypot(finger.at[0] - other.at[0], finger.at[1] - other.at[1]);
    const now = Math.hypot(at[0] - other.at[0], at[1] - other.at[1]);
    this.pan([(at[0] - finger.at[0]) / 2, (at[1] - finger.at[1]) / 2]);
    if (before > 0 && now > 0) this.zoom_at(now / before, [(at[0] + other.at[0]) / 2, (at[1] + other.at[1]) / 2]);
  }

  private pan(by: Point): void {
    const { frame } = this.colors.pictures;
    if (frame !== null) this.colors.view.set(panned(this.view!, by, frame, this.canvas));
  }

  private zoom_at(factor: number, anchor: Point): void {
    const { frame } = this.colors.pictures;
    if (frame === null) return;
    const view = zoomed(this.view!, factor, anchor, frame, this.canvas);
    this.colors.view.set(view.zoom === 1 ? null : view);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    // A notch of a wheel is about 100; fingers on a pad send many small steps.
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 : 1;
    this.zoom_at(Math.exp(-0.0025 * Math.min(Math.max(event.deltaY * lines, -200), 200)), this.canvas_point(event));
  }

  // Without a pointer: arrows move a cross, Enter does what a click would.

  private key(event: KeyboardEvent): void {
    const step = ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] } as Record<string, Point>)[event.key];
    if (event.ctrlKey || event.altKey || event.metaKey || this.colors.pictures.frame === null) return;
    if (step !== undefined) this.move_cursor(step, event.shiftKey ? 10 : 1);
    else if (event.key === "Enter" && this.colors.cursor.value !== null) this.enter(this.colors.cursor.value, event.timeStamp);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private move_cursor([dx, dy]: Point, by: number): void {
    const frame = this.colors.pictures.frame!;
    const [x, y] = this.colors.cursor.value ?? pixel_at(this.view!.center, frame);
    const to = pixel_at([x + by * dx, y + by * dy], frame);
    this.colors.cursor.set(to);
    this.colors.drag(to);
    this.probe(to);
    if (this.colors.view.value !== null) this.colors.view.set(showing(this.colors.view.value, to, frame, this.canvas));
  }

  private enter(at: Point, time: number): void {
    const { colors } = this;
    if (colors.tool.value === "select") colors.select_at(at, 1);
    else if (colors.tool.value === "polygon") colors.corner(at, 0.5, time);
    else if (colors.begun.value === null) colors.begin(at);
    else colors.finish(time);
  }
}
