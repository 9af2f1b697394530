import { useEffect } from "preact/hooks";
import { useValue } from "../link/observable";
import type { Session } from "../session";
import { OptionRow } from "../stages/option_row";
import { Brightness } from "./brightness";
import { ClassTable } from "./class_table";
import { title_of } from "./color_class";
import "./colors.css";
import type { ColorsSession } from "./colors_session";
import { options_of } from "./draft";
import { FilmStrip } from "./film_strip";
import { key_help, press } from "./keys";
import { LivePreview } from "./live_preview";
import { PicturePane } from "./picture_pane";
import { SavePane } from "./save_pane";
import { UvPane } from "./uv_pane";

/// Color training: draw what belongs to a class, see at once what comes of it, save it and use it.
export function ColorsPage({ session }: { session: Session }) {
  const { colors } = session;
  useEffect(() => {
    colors.open();
    session.want_pictures(false);
    const key = (event: KeyboardEvent): void => {
      if (!event.defaultPrevented && press(colors, event)) event.preventDefault();
    };
    addEventListener("keydown", key);
    return () => {
      removeEventListener("keydown", key);
      session.want_pictures(true);
      colors.close();
    };
  }, [session]);
  return (
    <div class="colors">
      <h1 class="unseen">Colors</h1>
      <Words colors={colors} />
      <div class="work">
        <PicturePane colors={colors} />
        <FilmStrip colors={colors} />
        <LivePreview colors={colors} />
        <Parameters colors={colors} />
      </div>
      <div class="judge">
        <ClassTable colors={colors} />
        <Chosen colors={colors} />
        <SavePane colors={colors} />
        <section class="help" aria-label="Keys">
          <details>
            <summary>Keys</summary>
            <dl>{key_help.map(([keys, what]) => <div key={keys}><dt><kbd>{keys}</kbd></dt><dd>{what}</dd></div>)}</dl>
          </details>
        </section>
      </div>
    </div>
  );
}

/// What must be read before anything else, and what is only read aloud.
function Words({ colors }: { colors: ColorsSession }) {
  const { notice, trouble, training } = useValue(colors.training.view);
  const said = useValue(colors.said);
  return (
    <div class="words">
      {trouble && <p class="notice" role="alert" data-show="trouble">{trouble}{training !== null && "; what you draw is kept here and sent when it answers"}</p>}
      {notice && (
        <p class="notice warning" role="alert" data-show="notice">
          <span>{notice}</span>
          <button type="button" onClick={() => colors.training.dismiss()}>understood</button>
        </p>
      )}
      <span class="unseen" role="status">{said}</span>
    </div>
  );
}

function Chosen({ colors }: { colors: ColorsSession }) {
  const { color } = useValue(colors.training.view);
  return (
    <section class="chosen-class" aria-label={`Colors of ${title_of(color)}`}>
      <header><h2>{title_of(color)}</h2></header>
      <Brightness colors={colors} />
      <UvPane colors={colors} />
    </section>
  );
}

function Parameters({ colors }: { colors: ColorsSession }) {
  const { training, history } = useValue(colors.training.view);
  const typed = useValue(colors.options.typed);
  const options = options_of(history.present, training?.options ?? []);
  const changed = options.filter((option) => option.changed).length;
  return (
    <section class="parameters" aria-label="Parameters" onChange={() => colors.training.end_gesture()}>
      <header>
        <h2>Parameters</h2>
        <span class="faint">{changed === 0 ? "all as usual" : `${changed} changed`}</span>
      </header>
      {options.map((option) => (
        <OptionRow key={option.key} option={option} model={colors.options} usual="the default" slide={(value) => colors.options.slide(option.key, value)} error={typed.errors.get(option.key)}
                   refused={typed.refused.get(option.key)} pending={false} />
      ))}
    </section>
  );
}
