import { type Api, type Change, type Option, reason, type Stage } from "../link/api";
import { Observable } from "../link/observable";

/// The stages as the server last told them, and what became of the changes asked for.
export interface StagesView {
  readonly stages: readonly Stage[] | null;
  /// Why a key's change was refused; the key's value stays what it was.
  readonly errors: ReadonlyMap<string, string>;
  /// What was typed and refused, to be corrected rather than typed again.
  readonly refused: ReadonlyMap<string, string>;
  /// Keys on their way.
  readonly pending: ReadonlySet<string>;
  /// Why there are no stages.
  readonly trouble: string;
}

/// Changes go to the server one after another, so that its last answer is the last change's.
export class StagesModel {
  readonly view = new Observable<StagesView>({ stages: null, errors: new Map(), refused: new Map(), pending: new Set(), trouble: "" });
  private queue: Promise<void> = Promise.resolve();
  private waiting = 0;

  constructor(private readonly api: Api) {}

  /// What is asked while changes wait is not asked: their answers are newer.
  refresh(): Promise<void> {
    if (this.waiting > 0) return this.queue;
    return this.enqueue(async () => {
      try {
        this.update({ stages: await this.api.stages(), trouble: "" });
      } catch (error) {
        this.update({ trouble: reason(error) });
      }
    });
  }

  /// typed  for a number, as it stands in the field
  change(key: string, value: string | number | null, typed = ""): Promise<void> {
    return this.send({ [key]: value }, typed);
  }

  /// All that is changed goes back to the robot file's values.
  reset_all(): Promise<void> {
    const keys = changed_keys(this.view.value.stages ?? []);
    return keys.length === 0 ? this.queue : this.send(Object.fromEntries(keys.map((key) => [key, null])), "");
  }

  /// A value that is not even asked for.
  refuse(key: string, why: string, typed: string): void {
    const { errors, refused } = this.view.value;
    this.update({ errors: new Map(errors).set(key, why), refused: new Map(refused).set(key, typed) });
  }

  /// What was refused is not wanted any more.
  forget(key: string): void {
    const { errors, refused } = this.view.value;
    this.update({ errors: without(errors, [key]), refused: without(refused, [key]) });
  }

  value_of(key: string): number | null {
    if (this.view.value.errors.has(key)) return null;
    return (this.view.value.stages ?? []).flatMap(options_of).find((option) => option.key === key)?.value ?? null;
  }

  private send(change: Change, typed: string): Promise<void> {
    const keys = Object.keys(change);
    this.update({ pending: new Set([...this.view.value.pending, ...keys]), errors: without(this.view.value.errors, keys) });
    return this.enqueue(async () => {
      try {
        const stages = await this.api.change(change);
        this.update({ stages, refused: without(this.view.value.refused, keys), trouble: "" });
      } catch (error) {
        const errors = new Map(this.view.value.errors);
        const refused = new Map(this.view.value.refused);
        for (const key of keys) {
          errors.set(key, reason(error));
          if (typed !== "") refused.set(key, typed);
        }
        this.update({ errors, refused });
      }
      this.update({ pending: new Set([...this.view.value.pending].filter((key) => !keys.includes(key))) });
    });
  }

  private enqueue(work: () => Promise<void>): Promise<void> {
    ++this.waiting;
    this.queue = this.queue.then(work).finally(() => --this.waiting);
    return this.queue;
  }

  private update(part: Partial<StagesView>): void {
    this.view.set({ ...this.view.value, ...part });
  }
}

function without<T>(map: ReadonlyMap<string, T>, keys: readonly string[]): Map<string, T> {
  return new Map([...map].filter(([key]) => !keys.includes(key)));
}

/// Also of alternatives that are not chosen: they count once they are.
export function options_of(stage: Stage): Option[] {
  return [...stage.alternatives.flatMap((alternative) => alternative.options), ...stage.options];
}

/// Keys whose value is not the robot file's.
export function changed_keys(stages: readonly Stage[]): string[] {
  return stages.flatMap((stage) => [
    ...(stage.changed ? [stage.key] : []),
    ...options_of(stage).filter((option) => option.changed).map((option) => option.key),
  ]);
}

/// A stage of which only that is left which matches all words, in keys, names and meanings. All of it when the stage itself does;
/// nothing when nothing does.
export function matching(stage: Stage, query: string, only_changed: boolean): Stage | null {
  const words = query.toLowerCase().split(/\s+/).filter(Boolean);
  const hit = (...texts: string[]): boolean => words.every((word) => texts.some((text) => text.toLowerCase().includes(word)));
  const whole = hit(stage.key, stage.meaning);
  const keep = (option: Option): boolean => (whole || hit(option.key, option.meaning)) && (!only_changed || option.changed);
  const options = stage.options.filter(keep);
  const alternatives = stage.alternatives.map((alternative) => {
    const all = hit(alternative.name, alternative.meaning);
    return { ...alternative, options: alternative.options.filter((option) => (all && (!only_changed || option.changed)) || keep(option)) };
  });
  const choice = only_changed ? stage.changed === true && whole : stage.alternatives.some((a) => hit(a.name, a.meaning));
  const left = options.length > 0 || alternatives.some((alternative) => alternative.options.length > 0);
  return left || choice || (whole && !only_changed) ? { ...stage, options, alternatives } : null;
}

/// The number that a text means, as written in a robot file; a decimal comma is a slip that is easily made.
export function parsed_number(text: string): number | null {
  const trimmed = text.trim().replace(/^(-?\d*),(\d+)$/, "$1.$2");
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(trimmed) ? Number(trimmed) : null;
}
