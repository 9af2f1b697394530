import type { Option } from "../link/api";
import { type ColorClass, color_classes } from "./color_class";
import type { Interval } from "./classify";
import type { Shape } from "./shapes";

/// Pixels of one class in one picture.
export type Sample = Shape & { readonly image: string; readonly class: ColorClass };

/// All that a table is trained from. Immutable; edits share what they leave.
export interface Draft {
  readonly samples: readonly Sample[];
  /// By key; those that are missing have their default.
  readonly options: Readonly<Record<string, number>>;
  /// By class, instead of the trained ones.
  readonly brightness: Readonly<Partial<Record<ColorClass, Interval>>>;
}

export const empty_draft: Draft = { samples: [], options: {}, brightness: {} };

export function with_sample(draft: Draft, sample: Sample): Draft {
  return { ...draft, samples: [...draft.samples, sample] };
}

export function without_sample(draft: Draft, sample: Sample): Draft {
  return { ...draft, samples: draft.samples.filter((other) => other !== sample) };
}

/// A class as before any work on it: no samples, and nothing set by hand.
export function without_class(draft: Draft, color: ColorClass): Draft {
  return with_brightness({ ...draft, samples: draft.samples.filter((sample) => sample.class !== color) }, color, null);
}

/// interval  null: the trained one again
export function with_brightness(draft: Draft, color: ColorClass, interval: Interval | null): Draft {
  const { [color]: _, ...rest } = draft.brightness;
  return { ...draft, brightness: interval === null ? rest : { ...rest, [color]: interval } };
}

/// value  null: the default again
export function with_option(draft: Draft, key: string, value: number | null): Draft {
  const { [key]: _, ...rest } = draft.options;
  return { ...draft, options: value === null ? rest : { ...rest, [key]: value } };
}

/// The draft that a server tells, whose options are all there.
export function draft_of(told: { samples: readonly Sample[]; options: readonly Option[]; brightness: Draft["brightness"] }): Draft {
  const options = Object.fromEntries(told.options.filter(({ value, default: usual }) => value !== usual).map(({ key, value }) => [key, value]));
  return { samples: told.samples, options, brightness: told.brightness };
}

/// The options as a page shows them, with the draft's values.
export function options_of(draft: Draft, known: readonly Option[]): Option[] {
  return known.map((option) => {
    const value = draft.options[option.key] ?? option.default;
    return { ...option, value, changed: value !== option.default };
  });
}

/// Do they say the same, whatever the order of their keys, and whether or not defaults are named?
export function same_draft(a: Draft, b: Draft, known: readonly Option[]): boolean {
  return a === b || canonical(a, known) === canonical(b, known);
}

function canonical(draft: Draft, known: readonly Option[]): string {
  const samples = draft.samples.map((sample) => [sample.image, sample.class, ...shape_values(sample)]);
  const options = options_of(draft, known).map(({ key, value }) => [key, value]);
  return JSON.stringify([samples, options, color_classes.map((color) => draft.brightness[color] ?? null)]);
}

function shape_values(shape: Shape): unknown[] {
  if ("rectangle" in shape) return ["rectangle", shape.rectangle];
  if ("polygon" in shape) return ["polygon", shape.polygon];
  if ("stroke" in shape) return ["stroke", shape.stroke, shape.radius];
  return ["mask", shape.mask, shape.value];
}
