import { Observable } from "../link/observable";
import { fields_of, first_target, type TargetFields, text_of, why_no_target } from "./target";

export const most_targets = 4;

export interface TargetsView {
  readonly rows: readonly TargetFields[];
  /// They are not, or not yet, what the server has.
  readonly is_edited: boolean;
}

/// The targets as they are typed. What the server has is shown until something is typed; that is sent when all of it are targets.
export class TargetEditor {
  readonly view = new Observable<TargetsView>({ rows: [first_target], is_edited: false });
  private told_texts: readonly string[] = [];

  constructor(private readonly send: (targets: readonly string[]) => Promise<boolean>) {}

  /// What the server has; what is being typed is not disturbed.
  told(texts: readonly string[]): void {
    if (same(texts, this.told_texts)) return;
    this.told_texts = texts;
    if (!this.view.value.is_edited && texts.length > 0) this.view.set({ rows: texts.map(fields_of), is_edited: false });
  }

  edit(row: number, part: Partial<TargetFields>): void {
    this.replace(this.view.value.rows.map((fields, i) => (i === row ? { ...fields, ...part } : fields)));
  }

  add(): void {
    const { rows } = this.view.value;
    if (rows.length < most_targets) this.replace([...rows, rows.at(-1) ?? first_target]);
  }

  remove(row: number): void {
    const { rows } = this.view.value;
    if (rows.length > 1) this.replace(rows.filter((_, i) => i !== row));
  }

  /// Back to what the server has.
  revert(): void {
    this.view.set({ rows: this.told_texts.length > 0 ? this.told_texts.map(fields_of) : [first_target], is_edited: false });
  }

  /// Why a row is no target, or none that counts; empty when it is one.
  why(row: number): string {
    const { rows } = this.view.value;
    const fields = rows[row]!;
    const why = why_no_target(fields);
    if (why !== "") return why;
    const text = text_of(fields);
    return rows.slice(0, row).some((other) => why_no_target(other) === "" && text_of(other) === text) ? "is named twice" : "";
  }

  /// In their text form; null while one of them is no target.
  get texts(): readonly string[] | null {
    const { rows } = this.view.value;
    return rows.every((_, i) => this.why(i) === "") ? rows.map(text_of) : null;
  }

  /// Sends them if they are targets, and others than the server has. False: they could not be sent, or were refused.
  async commit(): Promise<boolean> {
    const texts = this.texts;
    if (texts === null) return false;
    if (!same(texts, this.told_texts)) {
      const { rows } = this.view.value;
      if (!(await this.send(texts))) return false;
      this.told_texts = texts;
      if (this.view.value.rows !== rows) return true;   // typed on meanwhile
    }
    this.view.set({ rows: texts.map(fields_of), is_edited: false });
    return true;
  }

  private replace(rows: readonly TargetFields[]): void {
    this.view.set({ rows, is_edited: true });
  }
}

function same(a: readonly string[], b: readonly string[]): boolean {
  return a.length === b.length && a.every((text, i) => text === b[i]);
}
