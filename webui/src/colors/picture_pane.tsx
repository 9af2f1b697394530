import { useEffect, useRef, useState } from "preact/hooks";
import { count } from "../format";
import { useValue } from "../link/observable";
import { ClassDot } from "./class_dot";
import { color_classes, title_of } from "./color_class";
import { type ColorsSession, type Mode, modes } from "./colors_session";
import { type Tool, tools } from "./drawing";
import { kind_of } from "./shapes";
import { PictureCanvas } from "./picture_canvas";

const mode_titles: Record<Mode, string> = { picture: "Picture", luma: "Y", overlay: "Overlay", labels: "Classes", difference: "Difference" };
const tool_keys: Record<Tool, string> = { polygon: "p", rectangle: "r", brush: "b", select: "s" };

/// The picture that is shown, what is drawn on it, and the tools for that.
export function PicturePane({ colors }: { colors: ColorsSession }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [picture, set_picture] = useState<PictureCanvas | null>(null);
  useEffect(() => {
    const made = new PictureCanvas(canvas.current!, colors);
    set_picture(made);
    return () => made.end();
  }, [colors]);
  useEffect(() => {
    const zoom = (event: KeyboardEvent): void => {
      if ((event.target as HTMLElement).closest("input:not([type=range], [type=checkbox], [type=radio]), textarea, select")) return;
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      if (event.key === "+" || event.key === "=") picture?.zoom(1.5);
      else if (event.key === "-") picture?.zoom(1 / 1.5);
      else if (event.key === "f") picture?.fit();
    };
    addEventListener("keydown", zoom);
    return () => removeEventListener("keydown", zoom);
  }, [picture]);
  const tool = useValue(colors.tool);
  return (
    <section class="looked-at" aria-label="Picture">
      <ModeBar colors={colors} />
      <div class={`stage-of-picture ${tool}`}>
        <canvas ref={canvas} tabIndex={0} role="application" data-show="color-picture"
                aria-label="picture to draw samples on; arrow keys move a cross, Enter does what a click would, n selects the next sample" />
        <PictureWords colors={colors} />
        <div class="zooms">
          <button type="button" aria-label="zoom in" title="zoom in (+)" onClick={() => picture?.zoom(1.5)}>+</button>
          <button type="button" aria-label="zoom out" title="zoom out (−)" onClick={() => picture?.zoom(1 / 1.5)}>−</button>
          <button type="button" aria-label="whole picture" title="whole picture (f)" onClick={() => picture?.fit()}>fit</button>
        </div>
      </div>
      <ToolBar colors={colors} />
      <ClassDots colors={colors} />
      <ProbeLine colors={colors} />
    </section>
  );
}

function ModeBar({ colors }: { colors: ColorsSession }) {
  const mode = useValue(colors.mode);
  const opacity = useValue(colors.opacity);
  const changed = useValue(colors.changed);
  return (
    <div class="row">
      <div class="choices" role="group" aria-label="what is shown (v)">
        {modes.map((each) => (
          <button key={each} type="button" aria-pressed={mode === each} data-mode={each} onClick={() => colors.mode.set(each)}
                  title={each === "difference" ? "what the table in use says otherwise; v goes through all" : "v goes through all"}>
            {mode_titles[each]}
          </button>
        ))}
      </div>
      {mode === "overlay" && (
        <label class="inline">
          strength
          <input type="range" min={0.1} max={1} step={0.05} value={opacity} aria-label="strength of the classes over the picture"
                 onInput={(event) => colors.opacity.set(Number(event.currentTarget.value))} />
        </label>
      )}
      {mode === "difference" && (
        <span data-show="changed">
          {changed === null ? <span class="faint">no table to compare with</span>
            : <><b>{((100 * changed.pixels) / changed.of).toFixed(2)} %</b> <span class="faint">of the pixels ({count(changed.pixels)}) change against the table in use;
                pink: lose their class</span></>}
        </span>
      )}
    </div>
  );
}

/// What stands over the picture: which it is, and why there is none.
function PictureWords({ colors }: { colors: ColorsSession }) {
  const shown = useValue(colors.pictures.shown);
  const live = useValue(colors.pictures.live);
  const loaded = useValue(colors.pictures.loaded);
  const { training } = useValue(colors.training.view);
  const is_there = shown.kind === "live" ? live !== null : shown.kind === "keeping" || loaded.has(shown.id);
  const name = shown.kind === "kept" ? (training?.images.find(({ id }) => id === shown.id)?.name ?? shown.id) : "";
  return (
    <>
      <span class={`what ${shown.kind === "live" ? "is-live" : ""}`}>{shown.kind === "live" ? "live" : shown.kind === "keeping" ? "keeping" : name}</span>
      {!is_there && <p class="no-picture">{shown.kind === "live" ? "no live picture yet" : "the picture is on its way"}</p>}
    </>
  );
}

/// On narrow pages the table of classes is far below; they can be chosen here too.
function ClassDots({ colors }: { colors: ColorsSession }) {
  const { color: chosen } = useValue(colors.training.view);
  return (
    <div class="class-dots" role="group" aria-label="class to draw">
      {color_classes.map((color) => (
        <button key={color} type="button" aria-pressed={color === chosen} aria-label={title_of(color)} title={title_of(color)} onClick={() => colors.choose(color)}>
          <ClassDot color={color} />
        </button>
      ))}
    </div>
  );
}

function ToolBar({ colors }: { colors: ColorsSession }) {
  const tool = useValue(colors.tool);
  const radius = useValue(colors.radius);
  const selected = useValue(colors.selected);
  const begun = useValue(colors.begun);
  const { history, color } = useValue(colors.training.view);
  const there = selected !== null && history.present.samples.includes(selected) ? selected : null;
  const hint = begun?.tool === "polygon" ? "click the first corner or press Enter to close, Backspace takes a corner back, Escape all"
    : tool === "polygon" ? `click corners for ${title_of(color)}; drag moves the picture`
    : tool === "rectangle" ? `drag a rectangle for ${title_of(color)}`
    : tool === "brush" ? `paint ${title_of(color)}`
    : there !== null ? `${kind_of(there)} of ${title_of(there.class)}` : "click a sample to select it; drag moves the picture";
  return (
    <div class="row">
      <div class="choices" role="group" aria-label="tools">
        {tools.map((each) => (
          <button key={each} type="button" aria-pressed={tool === each} aria-keyshortcuts={tool_keys[each]} title={`${each} (${tool_keys[each]})`}
                  data-tool={each} onClick={() => colors.choose_tool(each)}>
            {each}
          </button>
        ))}
      </div>
      {tool === "brush" && (
        <span class="choices" role="group" aria-label="brush">
          <button type="button" aria-label="smaller brush" title="smaller ([)" onClick={() => colors.change_radius(-1)}>[</button>
          <span class="value" data-show="radius">{radius} px</span>
          <button type="button" aria-label="larger brush" title="larger (])" onClick={() => colors.change_radius(1)}>]</button>
        </span>
      )}
      {begun?.tool === "polygon" && (
        <>
          <button type="button" disabled={begun.corners.length < 3} onClick={(event) => colors.finish(event.timeStamp)}>close</button>
          <button type="button" onClick={() => colors.begun.set(null)}>drop it</button>
        </>
      )}
      {there !== null && <button type="button" title="delete (Delete)" onClick={() => colors.remove(there)}>delete</button>}
      <div class="choices undo" role="group" aria-label="steps">
        <button type="button" disabled={history.undoes === null && begun === null} aria-keyshortcuts="u Control+z" data-show="undo"
                title={`undo${history.undoes ? `: ${history.undoes}` : ""} (u or Ctrl+Z)`} onClick={() => colors.undo()}>undo</button>
        <button type="button" disabled={history.redoes === null} aria-keyshortcuts="Control+Shift+z" data-show="redo"
                title={`redo${history.redoes ? `: ${history.redoes}` : ""} (Ctrl+Shift+Z or Ctrl+Y)`} onClick={() => colors.redo()}>redo</button>
      </div>
      <span class="faint hint">{hint}</span>
    </div>
  );
}

/// The pixel under the pointer in numbers.
function ProbeLine({ colors }: { colors: ColorsSession }) {
  const probe = useValue(colors.probe);
  return (
    <p class="under probe" data-show="probe">
      {probe === null ? <span class="faint">point at the picture to see a pixel's numbers</span>
        : <>({probe.at[0]}, {probe.at[1]}) · Y {probe.y} · U {probe.u} · V {probe.v} · {probe.label === null ? "" : title_of(color_classes[probe.label]!)}</>}
    </p>
  );
}
