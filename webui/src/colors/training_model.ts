import { reason, Refused } from "../link/api";
import { Observable } from "../link/observable";
import type { ImageEntry, Quality, Result, Training, TrainingApi } from "../link/training_api";
import { Classifier } from "./classify";
import type { ColorClass } from "./color_class";
import { type Draft, draft_of, empty_draft, same_draft } from "./draft";
import { History } from "./history";

/// What the page shows of the training.
export interface TrainingView {
  /// As the server last told it; the draft in it may be older than `history`.
  readonly training: Training | null;
  readonly history: History<Draft>;
  /// Whose histograms are shown.
  readonly color: ColorClass;
  readonly result: Result | null;
  /// Of the result.
  readonly classifier: Classifier | null;
  /// When the draft of the result was drawn, on the page's clock; null when it was not drawn here. [ms]
  readonly drawn_at: number | null;
  /// Of the table that the vision uses.
  readonly in_use: Classifier | null;
  /// Null while it is not known for the draft as it is.
  readonly quality: Quality | null;
  readonly is_saved: boolean;
  /// Something is on its way to the server.
  readonly is_busy: boolean;
  /// Why the server cannot be asked now; it is asked again.
  readonly trouble: string;
  /// What must be told once, until it is read.
  readonly notice: string;
}

/// What the model takes from its surroundings; tests bring their own.
export interface TrainingClock {
  /// Returns what cancels it.
  after(ms: number, call: () => void): () => void;
}

const retry_ms = 1000;
/// A draft that nobody changed for so long is asked for its quality. [ms]
const quality_delay_ms = 700;
const watch_ms = 2000;

export const lost_with_the_program = (samples: number): string =>
  `The program was started anew: ${samples === 1 ? "one sample" : `${samples} samples`} in pictures that were not saved went with it.`;
export const changed_elsewhere = "Samples or parameters were changed elsewhere, in another browser or because the program was started anew. Those are shown now, and undo brings yours back.";

/// The draft here, and the server that trains it. At most one request that changes something is on its way; what is edited meanwhile waits, and only its
/// newest is sent. Nothing that was edited here is ever lost: what another browser did becomes one more step of the history.
export class TrainingModel {
  readonly view = new Observable<TrainingView>({
    training: null, history: History.of(empty_draft), color: "green", result: null, classifier: null, drawn_at: null, in_use: null, quality: null,
    is_saved: true, is_busy: false, trouble: "", notice: "",
  });
  private version = 0;
  /// The draft that the server has, and those that it may have got since without our hearing of it.
  private accepted: Draft | null = null;
  private sent = new Set<Draft>();
  private saved: Draft | null = null;
  /// The class whose histograms the result has.
  private seen: ColorClass | null = null;
  private running: Promise<void> | null = null;
  /// Grows with everything that makes an answer on its way too old.
  private changes = 0;
  private readonly drawn = new WeakMap<Draft, number>();
  private cancels: Partial<Record<"retry" | "quality" | "watch", () => void>> = {};
  private is_open = false;

  constructor(private readonly api: TrainingApi, private readonly clock: TrainingClock) {}

  get draft(): Draft {
    return this.view.value.history.present;
  }

  /// While the page is shown, the server is asked what others do.
  open(): void {
    if (this.is_open) return;
    this.is_open = true;
    void this.look();
  }

  close(): void {
    this.is_open = false;
    for (const cancel of Object.values(this.cancels)) cancel();
    this.cancels = {};
    // What is still to be sent is sent.
    void this.work();
  }

  /// gesture   as in `History`
  /// drawn_at  of the pointer event that made it, [ms]
  edit(draft: Draft, what: string, gesture = "", drawn_at?: number): void {
    if (draft === this.draft || this.view.value.training === null) return;
    if (drawn_at !== undefined) this.drawn.set(draft, drawn_at);
    this.step(this.view.value.history.edit(draft, what, gesture));
  }

  end_gesture(): void {
    this.update({ history: this.view.value.history.close() });
  }

  undo(): void {
    this.step(this.view.value.history.undo());
  }

  redo(): void {
    this.step(this.view.value.history.redo());
  }

  choose(color: ColorClass): void {
    this.update({ color });
    void this.work();
  }

  dismiss(): void {
    this.update({ notice: "" });
  }

  tell(notice: string): void {
    this.update({ notice });
  }

  async save(notes: string): Promise<boolean> {
    await this.work();
    if (this.accepted !== this.draft) return false;   // the trouble is told
    return this.mutate("not saved", () => this.api.save(this.version, notes), true);
  }

  async restore(id: string): Promise<boolean> {
    return this.mutate("not taken over", () => this.api.restore(id), true);
  }

  /// Throws when it cannot be kept.
  async keep(frame: number | null): Promise<ImageEntry> {
    ++this.changes;
    const image = await this.api.keep(frame);
    ++this.changes;
    const { training } = this.view.value;
    if (training !== null && !training.images.some(({ id }) => id === image.id)) this.update({ training: { ...training, images: [...training.images, image] } });
    return image;
  }

  async forget(id: string): Promise<boolean> {
    return this.mutate("not forgotten", () => this.api.forget(id), false);
  }

  /// Could a step of the history need the picture?
  needs(id: string): boolean {
    return this.view.value.history.some(({ samples }) => samples.some((sample) => sample.image === id));
  }

  /// Everything that is edited has been sent, or cannot be now.
  settled(): Promise<void> {
    return this.work();
  }

  private step(history: History<Draft>): void {
    if (history === this.view.value.history) return;
    ++this.changes;
    this.update({ history, is_saved: this.is_saved(history.present), quality: null });
    void this.work();
  }

  private is_saved(draft: Draft): boolean {
    return this.saved !== null && same_draft(draft, this.saved, this.view.value.training?.options ?? []);
  }

  private async mutate(what: string, ask: () => Promise<Training>, changes_table: boolean): Promise<boolean> {
    await this.work();
    ++this.changes;
    this.update({ is_busy: true });
    try {
      const training = await ask();
      ++this.changes;
      this.take(training);
      if (changes_table) await this.take_table();
      return true;
    } catch (error) {
      if (error instanceof Refused && error.status === 409) await this.look();
      this.update({ notice: `${what}: ${reason(error)}` });
      return false;
    } finally {
      this.update({ is_busy: this.running !== null });
      void this.work();
    }
  }

  /// What the server tells of all, unless something was changed here since it was asked.
  private async look(): Promise<void> {
    this.cancels.watch?.();
    const changes = this.changes;
    try {
      const training = await this.api.training();
      if (changes === this.changes && this.running === null) {
        const used_before = in_use_of(this.view.value.training);
        this.take(training);
        if (this.view.value.in_use === null || in_use_of(training) !== used_before) await this.take_table();
      }
      this.update({ trouble: "" });
      await this.work();
    } catch (error) {
      this.update({ trouble: reason(error) });
    }
    if (this.is_open) this.cancels.watch = this.clock.after(watch_ms, () => void this.look());
  }

  private async take_table(): Promise<void> {
    this.update({ in_use: new Classifier(await this.api.table()) });
  }

  /// Theirs, when it is not what this page sent, is one more step: nothing of ours is lost.
  private take(training: Training): void {
    // Versions only grow, as long as it is the same server.
    const gone = training.version < this.version ? this.begin_anew(training) : 0;
    const { history } = this.view.value;
    const theirs = draft_of(training);
    const same = (draft: Draft | null): boolean => draft !== null && same_draft(draft, theirs, training.options);
    if (training.version !== this.version) this.seen = null;   // the result is of another version
    this.version = training.version;
    if (this.view.value.training === null) {
      this.accepted = theirs;
      this.update({ training, history: History.of(theirs) });
    } else if (same(history.present)) {
      this.accepted = history.present;
      this.update({ training });
    } else if (same(this.accepted) || [...this.sent].some(same)) {
      // Only what is edited here is newer; it is sent again.
      this.update({ training });
    } else {
      this.accepted = theirs;
      this.update({ training, history: history.edit(theirs, "change from elsewhere"), notice: changed_elsewhere, quality: null });
      this.seen = null;
    }
    if (training.is_saved) this.saved = theirs;
    else if (same(this.saved)) this.saved = null;
    this.update({ is_saved: this.is_saved(this.draft) });
    if (gone > 0) this.tell(lost_with_the_program(gone));
  }

  /// The server was started anew, and gives its pictures ids of its own: what is drawn here is kept where the picture is in a file, and is still there.
  /// Steps before are not: their ids may mean others now. Returns how many samples went with their pictures.
  private begin_anew(training: Training): number {
    const new_id = (id: string): string | null => {
      const before = this.view.value.training?.images.find((image) => image.id === id);
      const after = training.images.filter(({ name }) => name === before?.name);
      return before?.kept && after.length === 1 ? after[0]!.id : null;
    };
    const samples = this.draft.samples.flatMap((sample) => {
      const image = new_id(sample.image);
      return image === null ? [] : [{ ...sample, image }];
    });
    this.sent.clear();
    this.accepted = this.saved = null;
    this.seen = null;
    const gone = this.draft.samples.length - samples.length;
    this.update({ history: History.of({ ...this.draft, samples }) });
    return gone;
  }

  /// Sends until nothing is left to send. One at a time: who asks while it runs waits for the same.
  private work(): Promise<void> {
    this.running ??= this.send_all().finally(() => {
      this.running = null;
      this.update({ is_busy: false });
    });
    return this.running;
  }

  private async send_all(): Promise<void> {
    this.cancels.retry?.();
    // Everything else of this turn comes first, so that what is edited together goes together.
    await Promise.resolve();
    while (this.view.value.training !== null) {
      const { color, history: { present } } = this.view.value;
      if (present === this.accepted && color === this.seen) break;
      this.update({ is_busy: true });
      try {
        if (present === this.accepted) await this.ask_result(color);
        else await this.send(present, color);
        this.update({ trouble: "" });
      } catch (error) {
        if (!(await this.recover(error))) return;
      }
    }
    if (this.view.value.training !== null && this.view.value.quality === null) this.ask_quality_later();
  }

  private async send(draft: Draft, color: ColorClass): Promise<void> {
    this.sent.add(draft);
    const result = await this.api.put_draft(this.version, draft, color);
    this.sent.clear();
    ++this.changes;
    this.version = result.version;
    this.accepted = draft;
    this.show(result, color, this.drawn.get(draft) ?? null);
    this.drawn.delete(draft);
  }

  private async ask_result(color: ColorClass): Promise<void> {
    const result = await this.api.result(color);
    // Somebody was faster.
    if (result.version !== this.version) this.take(await this.api.training());
    if (result.version === this.version) this.show(result, color, null);
  }

  private show(result: Result, color: ColorClass, drawn_at: number | null): void {
    this.seen = color;
    const is_new = result.version !== this.view.value.result?.version;
    const classifier = is_new || this.view.value.classifier === null ? new Classifier(result.table) : this.view.value.classifier;
    this.update({ result, classifier, drawn_at, ...(is_new ? { quality: null } : {}) });
  }

  /// Returns whether to go on.
  private async recover(error: unknown): Promise<boolean> {
    try {
      if (error instanceof Refused && error.status === 409) {
        this.take(await this.api.training());
        return true;
      }
      if (error instanceof Refused && error.status >= 400 && error.status < 500 && error.status !== 401) {
        this.take_back(error.message);
        return true;
      }
    } catch (second) {
      error = second;
    }
    this.update({ trouble: reason(error) });
    this.cancels.retry = this.clock.after(retry_ms, () => void this.work());
    return false;
  }

  /// The server will never take this draft: back to the last that it took.
  private take_back(why: string): void {
    let { history } = this.view.value;
    while (history.undoes !== null && history.present !== this.accepted) history = history.undo();
    if (history.present !== this.accepted) history = this.view.value.history.edit(this.accepted ?? empty_draft, "refused change");
    this.update({ history, is_saved: this.is_saved(history.present), notice: `refused, and taken back: ${why}` });
  }

  private ask_quality_later(): void {
    this.cancels.quality?.();
    // Without samples there is nothing to judge.
    if (this.is_open && this.draft.samples.length > 0) this.cancels.quality = this.clock.after(quality_delay_ms, () => void this.ask_quality());
  }

  private async ask_quality(): Promise<void> {
    if (this.running !== null || this.draft !== this.accepted) return;   // asked again when that is done
    try {
      const quality = await this.api.quality();
      if (quality.version === this.version && !quality.is_running) {
        this.update({ quality });
        return;
      }
    } catch {
      // the watch tells what is wrong
    }
    if (this.running === null) this.ask_quality_later();
  }

  private update(part: Partial<TrainingView>): void {
    const before = this.view.value;
    // A view that is the same is not shown anew.
    if (Object.entries(part).every(([key, value]) => Object.is(before[key as keyof TrainingView], value))) return;
    this.view.set({ ...before, ...part });
  }
}

function in_use_of(training: Training | null): string | null {
  return training?.history.find(({ in_use }) => in_use)?.id ?? null;
}
