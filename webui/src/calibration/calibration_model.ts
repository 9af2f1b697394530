import { reason } from "../link/api";
import type { Calibration, CalibrationApi, CalibrationChange } from "../link/calibration_api";
import { Observable } from "../link/observable";

/// What was asked for and is on its way.
export type Action = "change" | "capture" | "forget" | "solve" | "save";

export interface CalibrationView {
  /// As the server last told it; null before.
  readonly calibration: Calibration | null;
  readonly pending: readonly Action[];
  /// What was chosen and is on its way, to be shown as chosen.
  readonly wanted: CalibrationChange;
  /// Why the last thing that was asked for was refused; empty when it was not, or something else was asked for since.
  readonly refusal: string;
  /// Why the server cannot be asked now; it is asked again.
  readonly trouble: string;
  /// The view that was captured just now; null a moment later.
  readonly captured: string | null;
  /// Grows with each other result.
  readonly results: number;
}

/// What the model takes from its surroundings; tests bring their own.
export interface Clock {
  now(): number;
  /// Returns what cancels it.
  after(ms: number, call: () => void): () => void;
}

/// Between two questions: while something happens, and while nothing does. [ms]
export const quick_ms = 250, slow_ms = 2000;
/// So long it is told that a view was captured. [ms]
export const told_ms = 1600;

/// How it stands with the calibration, asked for while the page is shown. Questions are one at a time, and an answer that was on its way while something was
/// changed is older than that and dropped; what is asked for goes one after another.
export class CalibrationModel {
  readonly view = new Observable<CalibrationView>({ calibration: null, pending: [], wanted: {}, refusal: "", trouble: "", captured: null, results: 0 });
  private is_open = false;
  private is_asking = false;
  private changes = 0;
  private queue: Promise<unknown> = Promise.resolve();
  private cancel_look: (() => void) | null = null;
  private cancel_told: (() => void) | null = null;

  constructor(private readonly api: CalibrationApi, private readonly clock: Clock) {}

  open(): void {
    if (this.is_open) return;
    this.is_open = true;
    void this.look();
  }

  close(): void {
    this.is_open = false;
    this.cancel_look?.();
    this.cancel_look = null;
  }

  change(change: CalibrationChange): Promise<boolean> {
    this.update({ wanted: { ...this.view.value.wanted, ...change } });
    return this.act("change", () => this.api.change(change));
  }

  capture(): Promise<boolean> {
    return this.act("capture", () => this.api.capture());
  }

  forget(id: string): Promise<boolean> {
    return this.act("forget", () => this.api.forget(id));
  }

  forget_all(): Promise<boolean> {
    return this.act("forget", () => this.api.forget_all());
  }

  solve(): Promise<boolean> {
    return this.act("solve", () => this.api.solve());
  }

  save(): Promise<boolean> {
    return this.act("save", () => this.api.save());
  }

  dismiss(): void {
    this.update({ refusal: "" });
  }

  residuals(): Promise<Blob> {
    return this.api.residuals();
  }

  /// Returns whether it was done; a refusal is told in the view.
  private act(action: Action, ask: () => Promise<Calibration>): Promise<boolean> {
    this.update({ pending: [...this.view.value.pending, action], refusal: "" });
    const done = this.queue.then(async () => {
      try {
        const calibration = await ask();
        this.settle(action);
        this.take(calibration);
        return true;
      } catch (error) {
        this.settle(action);
        this.update({ refusal: reason(error) });
        return false;
      } finally {
        this.look_after(0);
      }
    });
    this.queue = done;
    return done;
  }

  private settle(action: Action): void {
    ++this.changes;
    const { pending } = this.view.value;
    const at = pending.indexOf(action);
    const rest = pending.filter((_, i) => i !== at);
    this.update({ pending: rest, ...(rest.includes("change") ? {} : { wanted: {} }) });
  }

  private async look(): Promise<void> {
    if (this.is_asking) return;   // asks again when the answer is there
    this.is_asking = true;
    const begun = this.clock.now();
    const changes = this.changes;
    let period = slow_ms;
    try {
      const calibration = await this.api.calibration();
      if (changes === this.changes && this.view.value.pending.length === 0 && this.is_open) this.take(calibration);
      this.update({ trouble: "" });
      if (calibration.is_on || calibration.is_solving) period = quick_ms;
    } catch (error) {
      this.update({ trouble: reason(error) });
    }
    this.is_asking = false;
    this.look_after(changes === this.changes ? Math.max(period - (this.clock.now() - begun), 0) : 0);
  }

  private look_after(ms: number): void {
    this.cancel_look?.();
    this.cancel_look = this.is_open ? this.clock.after(ms, () => void this.look()) : null;
  }

  private take(calibration: Calibration): void {
    const before = this.view.value.calibration;
    const is_other = calibration.result !== null && JSON.stringify(calibration.result) !== JSON.stringify(before?.result ?? null);
    this.update({ calibration, results: this.view.value.results + (is_other ? 1 : 0) });
    if (before === null) return;
    const known = new Set(before.views.map(({ id }) => id));
    const fresh = calibration.views.filter(({ id }) => !known.has(id)).at(-1);
    if (fresh !== undefined) this.tell_captured(fresh.id);
  }

  private tell_captured(id: string): void {
    this.cancel_told?.();
    this.update({ captured: id });
    this.cancel_told = this.clock.after(told_ms, () => this.update({ captured: null }));
  }

  private update(part: Partial<CalibrationView>): void {
    const before = this.view.value;
    if (Object.entries(part).every(([key, value]) => Object.is(before[key as keyof CalibrationView], value))) return;
    this.view.set({ ...before, ...part });
  }
}
