import type { YuvFrame } from "../link/frame_bytes";
import type { Classifier } from "./classify";
import type { Mode } from "./colors_session";
import { cover_labels, paint_difference, paint_labels, paint_luma, paint_rgb } from "./paint";

export interface Wanted {
  readonly frame: YuvFrame;
  readonly mode: Mode;
  readonly opacity: number;
  /// Of the draft. Without it there is only the picture.
  readonly classifier: Classifier | null;
  /// Of the table in use, to which the draft is compared.
  readonly in_use: Classifier | null;
}

/// A frame as a canvas of its size, painted only when something of it changed.
export class FramePainter {
  readonly canvas = document.createElement("canvas");
  private readonly context = this.canvas.getContext("2d", { alpha: false })!;
  private image: ImageData | null = null;
  private painted: Wanted | null = null;
  private labels: Uint8Array = new Uint8Array(0);
  private labels_in_use: Uint8Array = new Uint8Array(0);
  /// The picture itself under the classes, which change more often.
  private base = new Uint32Array(0);
  private base_of: YuvFrame | null = null;
  /// By the difference picture; null for others.
  changed: number | null = null;

  /// Returns whether it was painted anew.
  paint(wanted: Wanted): boolean {
    const before = this.painted;
    const same = before !== null && (Object.keys(wanted) as (keyof Wanted)[]).every((key) => before[key] === wanted[key]);
    if (same) return false;
    this.painted = wanted;
    const { width, height } = wanted.frame;
    if (this.image === null || this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.image = this.context.createImageData(width, height);
    }
    this.fill(wanted, new Uint32Array(this.image.data.buffer));
    this.context.putImageData(this.image, 0, 0);
    return true;
  }

  private fill({ frame, mode, opacity, classifier, in_use }: Wanted, out: Uint32Array): void {
    this.changed = null;
    if (mode === "luma") return paint_luma(frame, out);
    if (mode === "picture" || classifier === null) return paint_rgb(frame, out);
    this.labels = classifier.frame(frame, this.labels);
    if (mode === "labels") return paint_labels(this.labels, out);
    if (mode === "overlay" || in_use === null) {
      this.paint_base(frame, out);
      return cover_labels(this.labels, opacity, out);
    }
    this.labels_in_use = in_use.frame(frame, this.labels_in_use);
    this.changed = paint_difference(frame, this.labels_in_use, this.labels, out);
  }

  private paint_base(frame: YuvFrame, out: Uint32Array): void {
    if (this.base_of !== frame) {
      if (this.base.length !== out.length) this.base = new Uint32Array(out.length);
      paint_rgb(frame, this.base);
      this.base_of = frame;
    }
    out.set(this.base);
  }
}
