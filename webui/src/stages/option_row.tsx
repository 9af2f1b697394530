import { useEffect, useRef } from "preact/hooks";
import type { Option } from "../link/api";
import { unit } from "../format";
import { parsed_number } from "./model";

/// Whose options they are.
export interface OptionOwner {
  /// value  null: the usual one again; typed as it stands in the field
  change(key: string, value: number | null, typed?: string): Promise<void>;
  /// A value that is not even asked for.
  refuse(key: string, why: string, typed: string): void;
  /// What was refused is not wanted any more.
  forget(key: string): void;
  /// Nothing while a change is refused.
  value_of(key: string): number | null;
}

interface Props {
  option: Option;
  model: OptionOwner;
  /// What reset goes back to, in words.
  usual?: string;
  /// With it, there is a slider too; it is told every value on the way.
  slide?: (value: number) => void;
  error: string | undefined;
  refused: string | undefined;
  pending: boolean;
}

/// One number. Enter, or leaving the field, asks for it; Escape takes back what was typed. A text field: a number field would swallow
/// what is no number, and turn with the mouse wheel.
export function OptionRow({ option, model, usual = "the robot file's value", slide, error, refused, pending }: Props) {
  const field = useRef<HTMLInputElement>(null);
  const shown = refused ?? String(option.value);
  useEffect(() => {
    // What somebody else changes does not disturb who types.
    if (field.current && document.activeElement !== field.current) field.current.value = shown;
  }, [shown, option.value]);

  const ask = (text: string): void => {
    if (text.trim() === shown && error === undefined) return;
    const value = parsed_number(text);
    if (value === null) model.refuse(option.key, "must be a number", text);
    else if (value === option.value) void clear(model, option, field.current!);
    else void model.change(option.key, value, text).then(() => settle(model, option.key, field.current));
  };
  const key = (event: KeyboardEvent): void => {
    const input = event.currentTarget as HTMLInputElement;
    if (event.key === "Enter") ask(input.value);
    if (event.key === "Escape") clear(model, option, input);
  };

  const id = `option-${option.key}`;
  const suffix = unit(option.unit);
  return (
    <div class={`option ${option.changed ? "changed" : ""} ${error ? "wrong" : ""}`} data-option={option.key}>
      <label for={id}>
        <code>{option.key}</code>
        {option.changed && <small class="mark">changed</small>}
        <span class="meaning">{option.meaning}</span>
      </label>
      <span class="entry">
        <input ref={field} id={id} type="text" inputMode={option.low < 0 ? "text" : "decimal"} autocomplete="off" spellcheck={false} defaultValue={shown}
               aria-invalid={error !== undefined} aria-describedby={`${id}-range${error ? ` ${id}-error` : ""}`} aria-busy={pending}
               onBlur={(event) => ask(event.currentTarget.value)} onKeyDown={key} />
        <span class="unit">{suffix}</span>
        <button type="button" class="plain" disabled={!option.changed && error === undefined} aria-label={`reset ${option.key}`}
                title={`back to ${usual}`}
                onClick={() => (option.changed ? void model.change(option.key, null).then(() => settle(model, option.key, field.current)) : clear(model, option, field.current!))}>
          reset
        </button>
      </span>
      <small id={`${id}-range`} class="range">
        {option.low} to {option.high}{suffix && ` ${suffix}`}{option.whole && ", whole"} · default {option.default}
      </small>
      {slide && (
        <input type="range" class="slide" min={option.low} max={option.high} step={option.whole ? 1 : (option.high - option.low) / 200} value={option.value}
               aria-label={option.key} onInput={(event) => slide(Number(event.currentTarget.value))} />
      )}
      {error && <p id={`${id}-error`} class="error" role="alert" data-show={`error-${option.key}`}>{error}</p>}
    </div>
  );
}

/// After an answer the field has what the server has, unless it was refused: then the text stays to be corrected.
function settle(model: OptionOwner, key: string, field: HTMLInputElement | null): void {
  const value = model.value_of(key);
  if (field !== null && value !== null) field.value = String(value);
}

function clear(model: OptionOwner, option: Option, field: HTMLInputElement): void {
  model.forget(option.key);
  field.value = String(option.value);
}
