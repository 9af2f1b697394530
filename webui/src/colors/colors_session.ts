import { Observable } from "../link/observable";
import { server_training, type TrainingApi } from "../link/training_api";
import type { Point } from "../scene";
import { type ColorClass, color_classes, title_of } from "./color_class";
import { with_sample, without_class, without_sample, type Sample } from "./draft";
import { DraftOptions } from "./draft_options";
import { add_corner, begin, type Begun, drag, finish, next_radius, type Step, type Tool, without_corner } from "./drawing";
import { Pictures } from "./pictures";
import { hits, kind_of, type Shape } from "./shapes";
import { TrainingModel } from "./training_model";
import type { ImageView } from "./view_transform";

/// What is drawn of a picture.
export const modes = ["picture", "luma", "overlay", "labels", "difference"] as const;
export type Mode = (typeof modes)[number];

/// A pixel that is pointed at.
export interface Probe {
  readonly at: Point;
  readonly y: number;
  readonly u: number;
  readonly v: number;
  readonly label: number | null;
}

/// The color page, for as long as the program's page is open: leaving it for another view loses nothing.
export class ColorsSession {
  readonly training: TrainingModel;
  readonly pictures: Pictures;
  readonly options: DraftOptions;
  readonly tool = new Observable<Tool>("rectangle");
  readonly radius = new Observable(6);
  readonly mode = new Observable<Mode>("overlay");
  readonly opacity = new Observable(0.6);
  /// Null: the whole picture.
  readonly view = new Observable<ImageView | null>(null);
  readonly begun = new Observable<Begun | null>(null);
  readonly selected = new Observable<Sample | null>(null);
  readonly probe = new Observable<Probe | null>(null);
  /// Where arrow keys went.
  readonly cursor = new Observable<Point | null>(null);
  /// Pixels of the shown picture whose class another table changes; null while the difference is not shown.
  readonly changed = new Observable<{ pixels: number; of: number } | null>(null);
  /// What just happened, for those who do not see it.
  readonly said = new Observable("");

  constructor(frozen: Observable<boolean>, api: TrainingApi = server_training) {
    this.training = new TrainingModel(api, {
      after: (ms, call) => {
        const timer = setTimeout(call, ms);
        return () => clearTimeout(timer);
      },
    });
    this.pictures = new Pictures(api, this.training, frozen);
    this.options = new DraftOptions(this.training);
    // A telephone is on the radio, which robots need too, and has no room for two pictures.
    if (matchMedia("(max-width: 700px)").matches) this.pictures.preview.set(false);
    document.addEventListener("visibilitychange", () => this.pictures.listen());
    addEventListener("beforeunload", (event) => {
      if (this.has_unsaved_edits) event.preventDefault();
    });
  }

  /// Edits of this page that the files do not have.
  get has_unsaved_edits(): boolean {
    const { is_saved, history } = this.training.view.value;
    return (!is_saved && history.undoes !== null) || this.begun.value !== null;
  }

  open(): void {
    this.training.open();
    this.pictures.open();
  }

  close(): void {
    this.training.close();
    this.pictures.close();
    this.probe.set(null);
  }

  choose(color: ColorClass): void {
    this.training.choose(color);
    this.said.set(`class ${title_of(color)}`);
  }

  choose_tool(tool: Tool): void {
    if (tool === this.tool.value) return;
    this.begun.set(null);
    this.tool.set(tool);
    if (tool !== "select") this.selected.set(null);
    this.said.set(tool);
  }

  change_radius(direction: 1 | -1): void {
    this.radius.set(next_radius(this.radius.value, direction));
    this.said.set(`brush radius ${this.radius.value}`);
  }

  undo(): void {
    // A polygon on its way is undone corner by corner.
    if (this.begun.value !== null) return this.take_corner_back();
    const what = this.training.view.value.history.undoes;
    this.training.undo();
    this.said.set(what === null ? "nothing to undo" : `undone: ${what}`);
  }

  redo(): void {
    const what = this.training.view.value.history.redoes;
    this.training.redo();
    this.said.set(what === null ? "nothing to redo" : `done again: ${what}`);
  }

  take_corner_back(): void {
    this.begun.set(this.begun.value?.tool === "polygon" ? without_corner(this.begun.value) : null);
  }

  cancel(): void {
    this.begun.set(null);
    this.selected.set(null);
    this.cursor.set(null);
  }

  /// A click with the polygon. reach in pixels of the image; time of the event, [ms]
  corner(at: Point, reach: number, time: number): void {
    const size = this.pictures.frame;
    if (size === null) return;
    this.hold_for_drawing();
    this.take(add_corner(this.begun.value, at, reach, size), time);
  }

  begin(at: Point): void {
    const { frame } = this.pictures;
    const tool = this.tool.value;
    if (frame === null || (tool !== "rectangle" && tool !== "brush")) return;
    this.hold_for_drawing();
    this.begun.set(begin(tool, at, this.radius.value, frame));
  }

  drag(at: Point): void {
    const { frame } = this.pictures;
    if (this.begun.value !== null && frame !== null) this.begun.set(drag(this.begun.value, at, frame));
  }

  finish(time: number): void {
    const { frame } = this.pictures;
    if (this.begun.value !== null && frame !== null) this.take(finish(this.begun.value, frame), time);
  }

  select_at(at: Point, slack: number): boolean {
    const image = this.pictures.image;
    // The last drawn lies on top.
    const hit = this.training.draft.samples.filter((sample) => sample.image === image && hits(sample, at, slack)).at(-1) ?? null;
    this.selected.set(hit);
    if (hit !== null) this.said.set(`${kind_of(hit)} of ${title_of(hit.class)} selected`);
    return hit !== null;
  }

  /// The next sample of the shown picture, for those without a pointer.
  select_next(): void {
    const samples = this.training.draft.samples.filter((sample) => sample.image === this.pictures.image);
    if (samples.length === 0) return;
    const sample = samples[(samples.indexOf(this.selected.value!) + 1) % samples.length]!;
    this.choose_tool("select");
    this.selected.set(sample);
    this.said.set(`${kind_of(sample)} of ${title_of(sample.class)} selected`);
  }

  remove(sample: Sample | null): void {
    if (sample === null || !this.training.draft.samples.includes(sample)) return;
    this.selected.set(null);
    this.training.edit(without_sample(this.training.draft, sample), `${kind_of(sample)} of ${title_of(sample.class)} deleted`);
    this.said.set(`${kind_of(sample)} deleted`);
  }

  clear_class(color: ColorClass): void {
    this.training.edit(without_class(this.training.draft, color), `${title_of(color)} cleared`);
    this.said.set(`${title_of(color)} cleared, undo brings it back`);
  }

  async keep(): Promise<void> {
    if (this.pictures.shown.value.kind === "kept") return;
    if ((await this.pictures.hold()) !== null) this.said.set("picture kept");
  }

  /// null: the live picture
  look_at(id: string | null): void {
    this.begun.set(null);
    this.selected.set(null);
    if (id === null) this.pictures.show_live();
    else this.pictures.show(id);
  }

  /// A live picture stands still from the first touch on.
  private hold_for_drawing(): void {
    if (this.pictures.image !== null) return;
    void this.pictures.hold().then((id) => {
      if (id === null) this.begun.set(null);
    });
  }

  private take(step: Step, time: number): void {
    this.begun.set(step.begun);
    if (step.shape !== null) void this.add(step.shape, time);
  }

  private async add(shape: Shape, time: number): Promise<void> {
    const color = this.training.view.value.color;
    const image = await this.pictures.hold();
    if (image === null) return;
    const what = `${kind_of(shape)} of ${title_of(color)}`;
    this.training.edit(with_sample(this.training.draft, { ...shape, image, class: color }), what, "", time);
    this.said.set(what);
  }
}

/// The class that a digit key stands for.
export function class_of_key(key: string): ColorClass | null {
  return /^[0-8]$/.test(key) ? color_classes[Number(key)]! : null;
}
