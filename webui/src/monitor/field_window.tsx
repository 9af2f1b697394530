import { useEffect, useRef } from "preact/hooks";
import { useValue } from "../link/observable";
import { download } from "./download";
import { FieldPainter } from "./field_painter";
import { follow_pointer } from "./field_pointer";
import { all_layers } from "./layers";
import { measure_words, place_words } from "./measuring";
import { file_words } from "./moment";
import type { MonitorSession } from "./monitor_session";
import { NewsList } from "./news_list";
import { PicturePane } from "./picture_pane";
import { presence_words } from "./columns";
import { opponents_words, team_ball_words } from "./team_words";
import { split_off } from "./windows";

/// The field from above with all robots and what they see; beside it the chosen robot's picture, those without a pose, and the news.
export function FieldWindow({ session, is_alone }: { session: MonitorSession; is_alone: boolean }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const selected = useValue(session.selected);
  const save = (): void => {
    canvas.current!.toBlob((blob) => {
      if (blob !== null) download(blob, `field_${file_words(session.feed.drawn.value?.t ?? 0)}.png`);
    }, "image/png");
  };
  return (
    <section class="window field-window" aria-labelledby="field-title">
      <header>
        <h2 id="field-title">Field</h2>
        <LayerSwitches session={session} />
        <div class="actions">
          <MeasureButton session={session} />
          <button type="button" title="whole field (f)" onClick={() => session.camera.set(null)} data-show="fit">Fit</button>
          <button type="button" title="save the field as it is shown (s)" onClick={save} data-show="save-field">PNG</button>
          {!is_alone && <button type="button" title="the field in a window of its own" onClick={() => split_off("field")} data-show="split-field">Split off</button>}
        </div>
      </header>
      <div class="field-body">
        <FieldCanvas session={session} canvas={canvas} />
        <aside aria-label="Beside the field">
          {selected !== null && <PicturePane session={session} id={selected} />}
          <TeamBall session={session} />
          <WithoutPose session={session} />
          <NewsList session={session} />
        </aside>
      </div>
    </section>
  );
}

function LayerSwitches({ session }: { session: MonitorSession }) {
  const layers = useValue(session.layers);
  return (
    <div class="layers" role="group" aria-label="Layers">
      {all_layers.map(({ key, title }) => (
        <label key={key} class="inline">
          <input type="checkbox" checked={layers[key]} data-layer={key} onChange={() => session.toggle_layer(key)} />
          {title}
        </label>
      ))}
    </div>
  );
}

function MeasureButton({ session }: { session: MonitorSession }) {
  const on = useValue(session.measuring);
  return (
    <button type="button" class="measure-button" aria-pressed={on} title="with one finger (m); a mouse measures by dragging" onClick={() => session.measuring.set(!on)}>Measure</button>
  );
}

/// Preact makes the canvas and leaves the rest to the painter.
function FieldCanvas({ session, canvas }: { session: MonitorSession; canvas: { current: HTMLCanvasElement | null } }) {
  const place = useRef<HTMLSpanElement>(null);
  useEffect(() => {
    const painter = new FieldPainter(canvas.current!, session);
    const end = follow_pointer(painter, session, (point) => {
      place.current!.textContent = point === null ? "" : place_words(point);
    });
    return () => {
      end();
      painter.end();
    };
  }, [session]);
  return (
    <div class="field-canvas">
      <canvas ref={canvas} tabIndex={0} role="img" data-show="field"
              aria-label="the field from above with all robots and what they see; the table says in words what is known of each robot; n and p choose one" />
      <p class="readout"><span ref={place} data-show="place" /><MeasureReadout session={session} /></p>
    </div>
  );
}

function MeasureReadout({ session }: { session: MonitorSession }) {
  const measure = useValue(session.measure);
  return <span role="status" data-show="measure">{measure === null ? "" : measure_words(measure)}</span>;
}

/// What all know together, in words.
function TeamBall({ session }: { session: MonitorSession }) {
  const picture = useValue(session.feed.read);
  if (picture === null) return null;
  return (
    <section class="team-ball" aria-label="Team ball and opponents">
      <h3>Team ball</h3>
      <p><span data-show="team-ball">{team_ball_words(picture)}</span> <span class="faint" data-show="opponents">{opponents_words(picture)}</span></p>
    </section>
  );
}

/// Whoever does not know where it is stands nowhere on the field.
function WithoutPose({ session }: { session: MonitorSession }) {
  const robots = (useValue(session.feed.read)?.robots ?? []).filter(({ scene }) => scene.pose === null);
  if (robots.length === 0) return null;
  return (
    <section class="without-pose" aria-label="Robots without a pose">
      <h3>Without a pose</h3>
      <ul data-show="without-pose">
        {robots.map((robot) => (
          <li key={robot.id}>
            <button type="button" class={`robot-chip ${robot.team}`} onClick={() => session.select(robot.id)}>{robot.id}</button>
            <span class={robot.presence === "here" ? "faint" : "warning-text"}>{presence_words(robot)}</span>
          </li>
        ))}
      </ul>
    </section>
  );
}
