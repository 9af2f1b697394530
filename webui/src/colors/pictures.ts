import { reason } from "../link/api";
import { browser_world, Channel } from "../link/channel";
import { type YuvFrame, parse_frame } from "../link/frame_bytes";
import { Observable } from "../link/observable";
import type { TrainingApi } from "../link/training_api";
import type { TrainingModel } from "./training_model";

/// keeping: a live picture that is being kept, which does not move any more
export type Shown =
  | { readonly kind: "live" }
  | { readonly kind: "keeping"; readonly frame: YuvFrame }
  | { readonly kind: "kept"; readonly id: string };

/// The live picture, the kept ones, and which of them is shown.
export class Pictures {
  readonly live = new Observable<YuvFrame | null>(null);
  readonly shown = new Observable<Shown>({ kind: "live" });
  /// Pixels of kept pictures, as far as they have come.
  readonly loaded = new Observable<ReadonlyMap<string, YuvFrame>>(new Map());
  /// The live picture is also wanted while a kept one is shown.
  readonly preview = new Observable(true);
  /// As they were when they were looked at last.
  private names = new Map<string, string>();
  private is_open = false;
  private holding: Promise<string | null> | null = null;
  private readonly loading = new Set<string>();
  /// Could not be had; asked again when they are chosen.
  private readonly given_up = new Set<string>();
  private readonly channel: Channel;
  /// Messages that were no frames.
  broken = 0;

  constructor(
    private readonly api: TrainingApi,
    private readonly training: TrainingModel,
    private readonly frozen: Observable<boolean>,
  ) {
    this.channel = new Channel(browser_world("/ws/frame"), (data) => this.message(data), () => {}, "arraybuffer");
    for (const source of [frozen, this.shown, this.preview]) source.subscribe(() => this.listen());
    training.view.subscribe(() => {
      this.drop_gone();
      void this.load_next();
    });
  }

  open(): void {
    this.is_open = true;
    this.listen();
    void this.load_next();
  }

  close(): void {
    this.is_open = false;
    this.listen();
  }

  /// Frames are large: they come only while they are looked at.
  listen(): void {
    const stands = this.frozen.value && this.live.value !== null;
    const wanted = this.is_open && !document.hidden && !stands && (this.shown.value.kind === "live" || this.preview.value);
    if (wanted) this.channel.start();
    else this.channel.stop();
  }

  /// Newest only: what comes before the screen is ready replaces what came before it.
  private message(data: unknown): void {
    // Frozen before there was any, the first one stands.
    if (this.frozen.value && this.live.value !== null) return;
    try {
      if (data instanceof ArrayBuffer) this.live.set(parse_frame(data));
    } catch {
      ++this.broken;
    }
    if (this.frozen.value) this.listen();
  }

  retry(): void {
    this.channel.retry();
  }

  /// The pixels that are shown; null while they have not come.
  get frame(): YuvFrame | null {
    const shown = this.shown.value;
    if (shown.kind === "live") return this.live.value;
    return shown.kind === "keeping" ? shown.frame : (this.loaded.value.get(shown.id) ?? null);
  }

  get image(): string | null {
    const shown = this.shown.value;
    return shown.kind === "kept" ? shown.id : null;
  }

  show_live(): void {
    this.shown.set({ kind: "live" });
  }

  show(id: string): void {
    this.shown.set({ kind: "kept", id });
    void this.load(id);
  }

  /// The picture that is shown, as one that stays: a live one is kept and shown from now on. Null when that cannot be, which is told, or when the server had
  /// only another one to keep: what was drawn on the one shown must not be taken for a place in that.
  hold(): Promise<string | null> {
    const shown = this.shown.value;
    if (shown.kind === "kept") return Promise.resolve(shown.id);
    if (this.holding !== null) return this.holding;
    const frame = this.live.value;
    if (frame === null) return Promise.resolve(null);
    this.shown.set({ kind: "keeping", frame });
    this.holding = this.keep(frame).finally(() => { this.holding = null; });
    return this.holding;
  }

  private async keep(frame: YuvFrame): Promise<string | null> {
    try {
      const { id } = await this.training.keep(frame.frame);
      const kept = await this.load(id);
      if (this.shown.value.kind === "keeping") this.show(id);
      if (kept === null) return null;
      if (kept.frame === frame.frame) return id;
      this.training.tell("The picture that was shown is no longer on the robot, so a newer one was kept. Draw again, on that one.");
      return null;
    } catch (error) {
      this.training.tell(`the picture cannot be kept: ${reason(error)}`);
      if (this.shown.value.kind === "keeping") this.show_live();
      return null;
    }
  }

  private async load(id: string): Promise<YuvFrame | null> {
    const there = this.loaded.value.get(id);
    if (there !== undefined) return there;
    this.loading.add(id);
    try {
      const frame = await this.api.pixels(id);
      this.loaded.set(new Map(this.loaded.value).set(id, frame));
      return frame;
    } catch (error) {
      this.training.tell(`picture ${id} cannot be shown: ${reason(error)}`);
      return null;
    } finally {
      this.loading.delete(id);
    }
  }

  /// A robot that was started anew may give their ids to others.
  private drop_gone(): void {
    const images = this.training.view.value.training?.images ?? [];
    const is_there = (id: string): boolean => {
      const image = images.find((other) => other.id === id);
      const name = this.names.get(id);
      return image !== undefined && (name === undefined || name === image.name);
    };
    const left = [...this.loaded.value].filter(([id]) => is_there(id));
    this.names = new Map(images.map(({ id, name }) => [id, name]));
    if (left.length < this.loaded.value.size) this.loaded.set(new Map(left));
    const shown = this.shown.value;
    if (shown.kind === "kept" && this.training.view.value.training !== null && !images.some(({ id }) => id === shown.id)) this.show_live();
  }

  /// One after another, for the film strip.
  private async load_next(): Promise<void> {
    if (!this.is_open || this.loading.size > 0) return;
    const next = this.training.view.value.training?.images.find(({ id }) => !this.loaded.value.has(id) && !this.given_up.has(id));
    if (next === undefined) return;
    if ((await this.load(next.id)) === null) this.given_up.add(next.id);
    void this.load_next();
  }
}
