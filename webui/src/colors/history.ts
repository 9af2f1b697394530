/// One step and all before it. Steps share what they have in common, so an endless list of them stays small.
interface Step<T> {
  readonly value: T;
  /// What led to it, in words.
  readonly what: string;
  readonly next: Step<T> | null;
}

/// Undo and redo without end. Immutable.
export class History<T> {
  private constructor(
    readonly present: T,
    private readonly what: string,
    private readonly past: Step<T> | null,
    private readonly future: Step<T> | null,
    /// Edits of one gesture, as a slider that is dragged, are one step.
    private readonly gesture: string,
  ) {}

  static of<T>(value: T): History<T> {
    return new History<T>(value, "", null, null, "");
  }

  /// A new edit drops what was undone. gesture: the same as in the edit before, and not empty: it goes on with that one.
  edit(value: T, what: string, gesture = ""): History<T> {
    const goes_on = gesture !== "" && gesture === this.gesture;
    const past = goes_on ? this.past : { value: this.present, what: this.what, next: this.past };
    return new History<T>(value, what, past, null, gesture);
  }

  /// The next edit is a step of its own.
  close(): History<T> {
    return this.gesture === "" ? this : new History(this.present, this.what, this.past, this.future, "");
  }

  undo(): History<T> {
    if (this.past === null) return this;
    const { value, what, next } = this.past;
    return new History(value, what, next, { value: this.present, what: this.what, next: this.future }, "");
  }

  redo(): History<T> {
    if (this.future === null) return this;
    const { value, what, next } = this.future;
    return new History(value, what, { value: this.present, what: this.what, next: this.past }, next, "");
  }

  /// What undo would take back, and redo do again, in words; nothing when there is nothing.
  get undoes(): string | null {
    return this.past === null ? null : this.what;
  }
  get redoes(): string | null {
    return this.future?.what ?? null;
  }

  /// Does it hold for the present, or for anything that can be undone or done again?
  some(holds: (value: T) => boolean): boolean {
    if (holds(this.present)) return true;
    for (const list of [this.past, this.future]) {
      for (let step = list; step !== null; step = step.next) if (holds(step.value)) return true;
    }
    return false;
  }
}
