import { useState } from "preact/hooks";
import { useValue } from "../link/observable";
import type { QualityByClass } from "../link/training_api";
import { color_classes, title_of } from "./color_class";
import type { ColorsSession } from "./colors_session";

/// Why the draft cannot be saved now; empty when it can.
export function why_not_saved({ refusal, trouble, is_saved, samples }: { refusal: string | null; trouble: string; is_saved: boolean; samples: number }): string {
  if (refusal === null) return "the server has not told its draft yet";
  if (refusal !== "") return refusal;
  if (trouble !== "") return trouble;
  if (is_saved) return "nothing has changed since it was saved";
  return samples === 0 ? "there are no samples: the table would be empty" : "";
}

export function SavePane({ colors }: { colors: ColorsSession }) {
  const { training, is_saved, is_busy, trouble, history } = useValue(colors.training.view);
  const [notes, set_notes] = useState("");
  const files = training?.files;
  const why = why_not_saved({ refusal: files?.refusal ?? null, trouble, is_saved, samples: history.present.samples.length });
  const save = async (): Promise<void> => {
    if (why !== "" || !(await colors.training.save(notes.trim()))) return;
    set_notes("");
    colors.said.set("saved, and taken over");
  };
  return (
    <section class="save" aria-label="Save">
      <header>
        <h2>Save and use</h2>
        <span class={is_saved ? "faint" : "mark"} data-show="saved">{is_saved ? "saved" : "not saved"}</span>
      </header>
      {files && <p class="under faint">Writes <code>{files.colors}</code> and <code>{files.samples}</code>, new pictures into <code>{files.images}</code>, and the robot uses the table at once.</p>}
      <form class="row" onSubmit={(event) => { event.preventDefault(); void save(); }}>
        <input type="text" value={notes} maxLength={500} placeholder="notes, such as place and light" aria-label="notes, kept with the table"
               onInput={(event) => set_notes(event.currentTarget.value)} />
        <button type="submit" class="primary" disabled={why !== "" || is_busy} data-show="save" title={why || "save (Ctrl+S)"}>Save and use</button>
      </form>
      {why !== "" && !is_saved && <p class="under" data-show="why-not-saved">{why}</p>}
      <Past colors={colors} />
    </section>
  );
}

/// Every table that was in use, newest first; any of them can be taken over again.
function Past({ colors }: { colors: ColorsSession }) {
  const { training } = useValue(colors.training.view);
  const [waits, set_waits] = useState(false);
  const take = async (id: string): Promise<void> => {
    set_waits(true);
    if (await colors.training.restore(id)) colors.said.set("taken over");
    set_waits(false);
  };
  const tables = training?.history ?? [];
  if (tables.length === 0) return null;
  return (
    <>
      <h3>Tables before</h3>
      <ul class="past" data-show="past">
        {tables.map(({ id, date, notes, in_use, quality }) => (
          <li key={id} class={in_use ? "chosen" : ""} data-table={id}>
            <span>
              <b>{local_time(date)}</b> <span class="faint" title={quality_in_full(quality)}>{quality_in_short(quality)}</span>
              {notes && <span class="notes">{notes}</span>}
            </span>
            {in_use ? <span class="in-use">in use</span>
              : <button type="button" disabled={waits} aria-label={`take over the table of ${local_time(date)}`} onClick={() => void take(id)}>take over</button>}
          </li>
        ))}
      </ul>
    </>
  );
}

/// A time in UTC as people here read it; as in names of files, its colons may be dashes, and it may have a number after it.
export function local_time(utc: string): string {
  const match = /^(\d{4}-\d\d-\d\d)T(\d\d)[:-](\d\d)[:-](\d\d)(?:\.\d+)?Z/.exec(utc);
  const date = new Date(match === null ? NaN : `${match[1]}T${match[2]}:${match[3]}:${match[4]}Z`);
  return Number.isNaN(date.getTime()) ? utc : date.toLocaleString(undefined, { dateStyle: "medium", timeStyle: "medium" });
}

/// The worst class is what a team has to know.
export function quality_in_short(quality: QualityByClass): string {
  let [worst, name] = [Infinity, ""];
  for (const color of color_classes) {
    for (const share of [quality[color]?.recall, quality[color]?.precision]) {
      if (share != null && share < worst) [worst, name] = [share, title_of(color)];
    }
  }
  return name === "" ? "quality unknown" : `worst: ${name} ${(100 * worst).toFixed(1)} %`;
}

function quality_in_full(quality: QualityByClass): string {
  const percent = (share: number | null | undefined): string => (share == null ? "?" : `${(100 * share).toFixed(1)} %`);
  return color_classes.filter((color) => quality[color] !== undefined)
    .map((color) => `${title_of(color)}: found ${percent(quality[color]!.recall)}, right ${percent(quality[color]!.precision)}`).join("\n");
}
