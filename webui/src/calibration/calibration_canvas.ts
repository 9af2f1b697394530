import { follow_size } from "../canvas/follow_size";
import { FramePainter } from "../colors/frame_painter";
import type { Calibration, View } from "../link/calibration_api";
import type { Point } from "../scene";
import type { CalibrationSession } from "./calibration_session";
import { cells_of } from "./coverage";
import { fit_of, outline_of } from "./fit";

const found_color = "#ffd83d", captured_color = "#4be08a", view_color = "#8fd3ff", rejected_color = "#ff7b80", pointed_color = "#ff6bdc";

/// The live picture in gray with what calibration sees in it, drawn when the screen is ready.
export class CalibrationCanvas {
  private readonly context: CanvasRenderingContext2D;
  private readonly painter = new FramePainter();
  private requested = 0;
  private readonly ends: (() => void)[] = [];

  constructor(private readonly canvas: HTMLCanvasElement, private readonly session: CalibrationSession) {
    this.context = canvas.getContext("2d", { alpha: false })!;
    const request = (): void => {
      if (this.requested === 0) this.requested = requestAnimationFrame(() => this.draw());
    };
    const { frames, model, pointed, shows_coverage, shows_outlines } = session;
    for (const source of [frames.newest, model.view, pointed, shows_coverage, shows_outlines]) this.ends.push(source.subscribe(request));
    this.ends.push(follow_size(canvas, () => this.density, () => this.draw()));
    request();
  }

  end(): void {
    cancelAnimationFrame(this.requested);
    for (const end of this.ends) end();
  }

  private get density(): number {
    return Math.max(1, Math.min(devicePixelRatio, 2));
  }

  private draw(): void {
    this.requested = 0;
    const { canvas, context, session } = this;
    const frame = session.frames.newest.value;
    const { calibration } = session.model.view.value;
    const size = calibration !== null && calibration.width > 0 && calibration.height > 0 ? calibration : frame;
    context.globalAlpha = 1;
    context.fillStyle = "#0c1218";
    context.fillRect(0, 0, canvas.width, canvas.height);
    if (size === null) return;
    // The observer of the canvas's size draws again.
    canvas.style.setProperty("--shape", String(size.width / size.height));
    if (frame !== null) {
      this.painter.paint({ frame, mode: "luma", opacity: 1, classifier: null, in_use: null });
      context.imageSmoothingEnabled = true;
      context.drawImage(this.painter.canvas, 0, 0, canvas.width, canvas.height);
      canvas.dataset["frame"] = String(frame.frame);
    }
    if (calibration !== null) this.draw_calibration(calibration, canvas.width / size.width, canvas.height / size.height);
  }

  private draw_calibration(calibration: Calibration, sx: number, sy: number): void {
    const { session, canvas } = this;
    // A pixel's middle is its place.
    const at = ([x, y]: Point): Point => [(x + 0.5) * sx, (y + 0.5) * sy];
    // Before it is begun all would be missing, which nobody wants to know yet.
    if (session.shows_coverage.value && (calibration.is_on || calibration.views.length > 0)) this.draw_coverage(calibration);
    if (session.shows_outlines.value) for (const view of calibration.views) this.draw_outline(view, at);
    const fit = this.draw_now(calibration, at);
    const captured = calibration.views.find(({ id }) => id === session.model.view.value.captured);
    if (captured !== undefined) this.draw_points(captured.points, at, captured_color, 1);
    const pointed = calibration.views.find(({ id }) => id === session.pointed.value);
    if (pointed !== undefined) this.draw_points(pointed.points, at, pointed_color, 1);
    // What a picture alone cannot tell a test.
    Object.assign(canvas.dataset, {
      covered: String(calibration.coverage.points.filter((n) => n > 0).length), pointed: pointed?.id ?? "", points: String(fit > 0 ? calibration.now!.points.length : 0),
    });
  }

  private draw_coverage({ coverage }: Calibration): void {
    const { context, canvas, density } = this;
    for (const { x0, y0, x1, y1, color, alpha, is_empty } of cells_of(coverage)) {
      const [left, top] = [Math.round(x0 * canvas.width), Math.round(y0 * canvas.height)];
      const [width, height] = [Math.round(x1 * canvas.width) - left, Math.round(y1 * canvas.height) - top];
      context.fillStyle = color;
      context.globalAlpha = alpha;
      context.fillRect(left, top, width - density, height - density);
      if (!is_empty) continue;
      // A mark of its own, where colors are hard to see.
      context.globalAlpha = 0.8;
      context.fillRect(left + width / 2 - 3 * density, top + height / 2 - density / 2, 6 * density, density);
    }
  }

  private draw_outline(view: View, at: (point: Point) => Point): void {
    this.trace(outline_of(view.points).map(at), true);
    this.stroke(view.rejected === "" ? view_color : rejected_color, 1.2, 0.75, view.rejected === "" ? [] : [5, 4]);
  }

  /// Returns how well the points fit the picture.
  private draw_now({ is_on, now }: Calibration, at: (point: Point) => Point): number {
    const frame = this.session.frames.newest.value;
    if (!is_on || now === null || frame === null || now.points.length === 0) return 0;
    const fit = fit_of(now.frame, frame.frame, this.session.frames.rate_hz);
    if (fit > 0) this.draw_points(now.points, at, now.is_captured ? captured_color : found_color, fit);
    return fit;
  }

  private draw_points(points: readonly Point[], at: (point: Point) => Point, color: string, alpha: number): void {
    this.trace(outline_of(points).map(at), true);
    this.stroke(color, 3, alpha, []);
    for (const point of points) this.dot(at(point), 3.5, color, alpha);
  }

  private trace(points: readonly Point[], closed: boolean): void {
    this.context.beginPath();
    points.forEach(([x, y], i) => (i === 0 ? this.context.moveTo(x, y) : this.context.lineTo(x, y)));
    if (closed) this.context.closePath();
  }

  private stroke(color: string, width: number, alpha: number, dash: readonly number[]): void {
    const { context, density } = this;
    context.globalAlpha = alpha;
    context.strokeStyle = color;
    context.lineWidth = width * density;
    context.lineJoin = "round";
    context.setLineDash(dash.map((length) => length * density));
    context.stroke();
  }

  /// With a dark rim, to be seen on paper as well as on print; smaller in small pictures, where points lie close together.
  private dot([x, y]: Point, radius: number, color: string, alpha: number): void {
    const { context, density } = this;
    context.globalAlpha = alpha;
    context.setLineDash([]);
    context.beginPath();
    context.arc(x, y, Math.min(radius * density, this.canvas.width / 220), 0, 2 * Math.PI);
    context.fillStyle = color;
    context.fill();
    context.strokeStyle = "#0c1218";
    context.lineWidth = density;
    context.stroke();
  }
}
