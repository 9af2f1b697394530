import { type LensModel, lens_models } from "../link/calibration_api";
import { useValue } from "../link/observable";
import type { CalibrationSession } from "./calibration_session";
import { in_millimeters, type TargetFields, text_of, why_no_target } from "./target";
import { most_targets } from "./target_editor";

type FieldTitles = readonly (readonly ["columns" | "rows" | "pitch" | "radius" | "spacing", string])[];
const grid_titles: FieldTitles = [["columns", "columns"], ["rows", "rows"], ["pitch", "pitch [m]"]];
const field_titles: Readonly<Record<TargetFields["kind"], FieldTitles>> = {
  dots: [...grid_titles, ["radius", "radius [m]"]],
  checker: grid_titles,
  aprilgrid: [["columns", "tags across"], ["rows", "tags down"], ["pitch", "tag size [m]"], ["spacing", "gap, share of it"]],
};

/// What is held in front of the camera, and how to print it.
export function TargetPane({ session }: { session: CalibrationSession }) {
  const { rows, is_edited } = useValue(session.targets.view);
  const all_good = session.targets.texts !== null;
  const commit = (event: Event): void => {
    event.preventDefault();
    void session.targets.commit();
  };
  return (
    <section class="targets" aria-label="Target">
      <header>
        <h2>{rows.length === 1 ? "Target" : "Targets"}</h2>
        <span class={is_edited ? "mark" : "faint"} data-show="targets-state">{is_edited ? "not taken over yet" : "in use"}</span>
      </header>
      <form onSubmit={commit}>
        {rows.map((fields, i) => <TargetRow key={i} session={session} row={i} fields={fields} removable={rows.length > 1} />)}
        <div class="row">
          <button type="submit" class={is_edited ? "primary" : ""} disabled={!is_edited || !all_good} data-show="use-targets">Use</button>
          <button type="button" disabled={!is_edited} onClick={() => session.targets.revert()}>Take back</button>
          <button type="button" class="fill" disabled={rows.length >= most_targets} onClick={() => session.targets.add()}>Add another</button>
        </div>
        {rows.length > 1 && <p class="under faint">The first one that is found in a frame counts.</p>}
      </form>
    </section>
  );
}

function TargetRow({ session, row, fields, removable }: { session: CalibrationSession; row: number; fields: TargetFields; removable: boolean }) {
  const why = session.targets.why(row);
  const text = why_no_target(fields) === "" ? text_of(fields) : null;
  const set = (part: Partial<TargetFields>): void => session.targets.edit(row, part);
  return (
    <fieldset class="target" data-target={row}>
      <legend class="unseen">target {row + 1}</legend>
      <div class="target-fields">
        <label>
          <span>kind</span>
          <select value={fields.kind} onChange={(event) => set({ kind: event.currentTarget.value as TargetFields["kind"] })}>
            <option value="dots">dots</option>
            <option value="checker">checkerboard</option>
            <option value="aprilgrid">AprilGrid</option>
          </select>
        </label>
        {field_titles[fields.kind].map(([name, title]) => (
          <label key={name}>
            <span>{title}</span>
            <input type="text" inputMode="decimal" autocomplete="off" spellcheck={false} value={fields[name]} aria-invalid={why.startsWith(name)} data-field={name}
                   onInput={(event) => set({ [name]: event.currentTarget.value })} />
            {(name === "pitch" || name === "radius") && <small class="faint">{in_millimeters(fields[name])}</small>}
          </label>
        ))}
      </div>
      {why !== "" && <p class="error" role="alert" data-show={`target-error-${row}`}>{why}</p>}
      {text !== null && (
        <p class="under faint">
          {fields.kind === "checker" && "Columns and rows of inner corners. "}{fields.kind === "aprilgrid" && "It may leave the image, so it reaches the corners. "}Print it with <code class="command" data-show={`target-command-${row}`}>tassilo calibrate target {text} --output target.pdf</code>
        </p>
      )}
      {removable && <button type="button" class="plain" aria-label={`remove target ${row + 1}`} onClick={() => session.targets.remove(row)}>remove</button>}
    </fieldset>
  );
}

const model_meanings: Readonly<Record<LensModel, string>> = {
  division: "One coefficient. Needs the fewest views, and stays tame where no target was held. For most lenses of small robots.",
  plumb_bob: "k1 k2 p1 p2 k3, as in ROS and OpenCV. For lenses that are not very wide; beyond the covered part it can be far off.",
  equidistant: "k1 to k4 over the angle, Kannala-Brandt. For fisheye lenses.",
};

export function LensPane({ session }: { session: CalibrationSession }) {
  const { calibration, wanted } = useValue(session.model.view);
  const chosen = wanted.model ?? calibration?.model;
  return (
    <section class="lens" aria-label="Lens model">
      <header><h2>Lens model</h2></header>
      <fieldset disabled={calibration === null}>
        <legend class="unseen">lens model</legend>
        {lens_models.map((model) => (
          <label key={model} class={`choice ${chosen === model ? "chosen" : ""}`}>
            <input type="radio" name="lens-model" value={model} checked={chosen === model} onChange={() => void session.model.change({ model })} />
            <span><code>{model}</code><span class="meaning">{model_meanings[model]}</span></span>
          </label>
        ))}
      </fieldset>
      <p class="under faint">Another model keeps the views; what was worked out with the one before is dropped.</p>
    </section>
  );
}
