import { useValue } from "../link/observable";
import type { Session } from "../session";
import { KeyHelp, useWork, Words } from "../work_page";
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
  useWork(session, colors, press);
  return (
    <div class="colors">
      <h1 class="unseen">Colors</h1>
      <ColorsWords colors={colors} />
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
        <KeyHelp keys={key_help} />
      </div>
    </div>
  );
}

function ColorsWords({ colors }: { colors: ColorsSession }) {
  const { notice, trouble, training } = useValue(colors.training.view);
  const said = useValue(colors.said);
  const kept = trouble && training !== null ? "; what you draw is kept here and sent when it answers" : "";
  return <Words trouble={trouble + kept} notice={notice} show="notice" dismiss={() => colors.training.dismiss()} said={said} />;
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
