import { Observable } from "../link/observable";
import type { OptionOwner } from "../stages/option_row";
import { options_of, with_option } from "./draft";
import type { TrainingModel } from "./training_model";

export interface Typed {
  /// Why what was typed is refused, by key.
  readonly errors: ReadonlyMap<string, string>;
  readonly refused: ReadonlyMap<string, string>;
}

/// The parameters of the training as rows of options. What is out of range is refused here, so that the draft is always one that can be trained.
export class DraftOptions implements OptionOwner {
  readonly typed = new Observable<Typed>({ errors: new Map(), refused: new Map() });

  constructor(private readonly model: TrainingModel) {}

  async change(key: string, value: number | null, typed = ""): Promise<void> {
    const option = this.model.view.value.training?.options.find((o) => o.key === key);
    if (option === undefined) return;
    if (value !== null) {
      const why = value < option.low || value > option.high ? `is ${value}, must be ${option.low} to ${option.high}`
        : option.whole && !Number.isInteger(value) ? `is ${value}, must be whole` : "";
      if (why !== "") return this.refuse(key, why, typed);
    }
    this.forget(key);
    this.model.edit(with_option(this.model.draft, key, value === option.default ? null : value), key);
  }

  /// Dragging is one step of undo.
  slide(key: string, value: number): void {
    const option = this.model.view.value.training?.options.find((o) => o.key === key);
    if (option === undefined) return;
    this.forget(key);
    // As many digits as a step of the slider is worth; ends as they are.
    const rounded = option.whole ? Math.round(value) : Number(value.toPrecision(3));
    this.model.edit(with_option(this.model.draft, key, rounded === option.default ? null : rounded), key, `slide ${key}`);
  }

  refuse(key: string, why: string, typed: string): void {
    const { errors, refused } = this.typed.value;
    this.typed.set({ errors: new Map(errors).set(key, why), refused: new Map(refused).set(key, typed) });
  }

  forget(key: string): void {
    const keep = (map: ReadonlyMap<string, string>): Map<string, string> => new Map([...map].filter(([other]) => other !== key));
    this.typed.set({ errors: keep(this.typed.value.errors), refused: keep(this.typed.value.refused) });
  }

  value_of(key: string): number | null {
    if (this.typed.value.errors.has(key)) return null;
    const { training, history } = this.model.view.value;
    return options_of(history.present, training?.options ?? []).find((option) => option.key === key)?.value ?? null;
  }
}
