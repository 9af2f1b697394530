import { useEffect, useRef } from "preact/hooks";
import type { Option } from "../link/api";
import { unit } from "../format";
import { parsed_number, type StagesModel } from "./model";

interface Props {
  option: Option;
  model: StagesModel;
  error: string | undefined;
  refused: string | undefined;
  pending: boolean;
}

/// One number. Enter, or leaving the field, asks for it; Escape takes back what was typed. A text field: a number field would swallow
/// what is no number, and turn with the mouse wheel.
export function OptionRow({ option, model, error, refused, pending }: Props) {
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
                title="back to the robot file's value"
                onClick={() => (option.changed ? void model.change(option.key, null).then(() => settle(model, option.key, field.current)) : clear(model, option, field.current!))}>
          reset
        </button>
      </span>
      <small id={`${id}-range`} class="range">
        {option.low} to {option.high}{suffix && ` ${suffix}`}{option.whole && ", whole"} · default {option.default}
      </small>
      {error && <p id={`${id}-error`} class="error" role="alert" data-show={`error-${option.key}`}>{error}</p>}
    </div>
  );
}

/// After an answer the field has what the server has, unless it was refused: then the text stays to be corrected.
function settle(model: StagesModel, key: string, field: HTMLInputElement | null): void {
  const view = model.view.value;
  if (field === null || view.errors.has(key)) return;
  for (const stage of view.stages ?? []) {
    for (const option of [...stage.options, ...stage.alternatives.flatMap((a) => a.options)]) {
      if (option.key === key) field.value = String(option.value);
    }
  }
}

function clear(model: StagesModel, option: Option, field: HTMLInputElement): void {
  model.forget(option.key);
  field.value = String(option.value);
}
