import { useEffect, useRef, useState } from "preact/hooks";
import type { Option, Stage } from "../link/api";
import { PictureView } from "../live/picture_view";
import { Tiles } from "../live/tiles";
import { useValue } from "../link/observable";
import type { Session } from "../session";
import { OptionRow } from "./option_row";
import { changed_keys, matching, type StagesModel, type StagesView } from "./model";

/// The choice of every stage and option, beside the picture, so that an effect is seen where it was caused.
export function StagesPage({ session }: { session: Session }) {
  const view = useValue(session.stages.view);
  const [query, set_query] = useState("");
  const [only_changed, set_only_changed] = useState(false);
  const search = useRef<HTMLInputElement>(null);

  useEffect(() => {
    void session.stages.refresh();
    const find = (event: KeyboardEvent): void => {
      if (event.key !== "/" || (event.target as HTMLElement).closest("input, select, textarea")) return;
      event.preventDefault();
      search.current?.focus();
    };
    addEventListener("keydown", find);
    return () => removeEventListener("keydown", find);
  }, []);

  const stages = view.stages ?? [];
  const shown = stages.flatMap((stage) => matching(stage, query, only_changed) ?? []);
  const changed = changed_keys(stages).length;
  return (
    <div class="stages">
      <div class="settings">
        <div class="tools">
          <h1>Stages</h1>
          <input ref={search} type="search" placeholder="search (/)" aria-label="search stages and options" value={query}
                 onInput={(event) => set_query(event.currentTarget.value)} />
          <label class="inline">
            <input type="checkbox" checked={only_changed} onChange={(event) => set_only_changed(event.currentTarget.checked)} />
            changed only
          </label>
          <button type="button" disabled={changed === 0} onClick={() => void session.stages.reset_all()}>
            reset all{changed > 0 && ` (${changed})`}
          </button>
        </div>
        {view.trouble && <p class="notice" role="alert">{view.trouble}</p>}
        {view.stages === null && !view.trouble && <p class="faint">asking the server</p>}
        {view.stages !== null && shown.length === 0 && <p class="faint">nothing {only_changed ? "changed" : "found"}</p>}
        {shown.map((stage) => <StageSection key={stage.key} stage={stage} view={view} model={session.stages} searching={query.trim() !== "" || only_changed} />)}
      </div>
      <aside aria-label="Effect">
        <PictureView picture={session.picture} />
        <Tiles session={session} />
      </aside>
    </div>
  );
}

interface SectionProps {
  stage: Stage;
  view: StagesView;
  model: StagesModel;
  searching: boolean;
}

function StageSection({ stage, view, model, searching }: SectionProps) {
  const error = view.errors.get(stage.key);
  const chosen = stage.alternatives.find((alternative) => alternative.chosen);
  // Options of what is not chosen have no effect; they are shown only to those who look for them.
  const groups = [
    ...stage.alternatives.filter((a) => a.options.length > 0 && (a.chosen || searching)).map((a) => ({
      title: a.chosen ? `of ${a.name}` : `of ${a.name}, not chosen`, options: a.options,
    })),
    { title: stage.alternatives.length > 1 && chosen && chosen.options.length > 0 ? "of all alternatives" : "", options: stage.options },
  ].filter((group) => group.options.length > 0);
  return (
    <section class="stage" aria-labelledby={`stage-${stage.key}`} data-stage={stage.key}>
      <header>
        <h2 id={`stage-${stage.key}`}>{stage.key.replace("_", " ")}</h2>
        <p class="faint">{stage.meaning}</p>
      </header>
      {stage.alternatives.length === 1 && stage.alternatives.map((only) => (
        <p key={only.name}><b>{only.name}</b> <span class="faint">{only.meaning}</span></p>
      ))}
      {stage.alternatives.length > 1 && (
        <fieldset aria-busy={view.pending.has(stage.key)}>
          <legend class="unseen">alternative of {stage.key}</legend>
          {stage.alternatives.map((alternative) => (
            <label key={alternative.name} class={`choice ${alternative.chosen ? "chosen" : ""}`}>
              <input type="radio" name={stage.key} value={alternative.name} checked={alternative.chosen}
                     onChange={() => void model.change(stage.key, alternative.name)} />
              <span>
                <b>{alternative.name}</b>
                {alternative.default && <small class="faint"> default</small>}
                <span class="meaning">{alternative.meaning}</span>
              </span>
            </label>
          ))}
          {(stage.changed ?? chosen?.default === false) && (
            <button type="button" class="plain" onClick={() => void model.change(stage.key, null)}>reset to the robot file</button>
          )}
        </fieldset>
      )}
      {error && <p class="error" role="alert" data-show={`error-${stage.key}`}>{error}</p>}
      {groups.length > 0 && <details open={searching || undefined} key={searching ? "found" : "all"}>
        <summary>{summary(groups.flatMap((group) => group.options))}</summary>
        {groups.map((group) => (
        <div key={group.title} class="options">
          {group.title && <h3>{group.title}</h3>}
          {group.options.map((option) => (
            <OptionRow key={option.key} option={option} model={model} error={view.errors.get(option.key)}
                       refused={view.refused.get(option.key)} pending={view.pending.has(option.key)} />
          ))}
        </div>
        ))}
      </details>}
    </section>
  );
}

/// What a closed list of options holds.
function summary(options: readonly Option[]): string {
  const changed = options.filter((option) => option.changed).length;
  return `${options.length} ${options.length === 1 ? "option" : "options"}${changed > 0 ? `, ${changed} changed` : ""}`;
}
