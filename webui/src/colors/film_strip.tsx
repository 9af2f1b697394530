import { useEffect, useRef, useState } from "preact/hooks";
import type { YuvFrame } from "../link/frame_bytes";
import { useValue } from "../link/observable";
import { ClassDot } from "./class_dot";
import { title_of } from "./color_class";
import type { ColorsSession } from "./colors_session";
import { FramePainter } from "./frame_painter";
import { kind_of } from "./shapes";

/// The live picture and the kept ones, with how many samples each has.
export function FilmStrip({ colors }: { colors: ColorsSession }) {
  const shown = useValue(colors.pictures.shown);
  const loaded = useValue(colors.pictures.loaded);
  const { training, history } = useValue(colors.training.view);
  const samples = history.present.samples;
  const images = training?.images ?? [];
  const strip = useRef<HTMLUListElement>(null);
  useEffect(() => {
    // The shown one is in sight, also when it was just kept; only the strip moves, not the page.
    const list = strip.current!;
    const frame = list.querySelector<HTMLElement>("[aria-pressed=true]");
    if (frame === null) return;
    const [begin, end] = [frame.offsetLeft - list.offsetLeft, frame.offsetLeft - list.offsetLeft + frame.offsetWidth];
    if (begin < list.scrollLeft) list.scrollLeft = begin - 8;
    else if (end > list.scrollLeft + list.clientWidth) list.scrollLeft = end - list.clientWidth + 8;
  }, [shown, images.length]);
  return (
    <section class="film" aria-label="Pictures">
      <div class="row">
        <h2>Pictures</h2>
        <button type="button" disabled={shown.kind !== "live"} title="keep the live picture, to draw in (k)" aria-keyshortcuts="k" data-show="keep"
                onClick={() => void colors.keep()}>
          keep live picture
        </button>
        {shown.kind === "kept" && <Forget key={shown.id} colors={colors} id={shown.id} />}
      </div>
      <ul ref={strip} class="strip">
        <li>
          <button type="button" class="frame" aria-pressed={shown.kind === "live"} aria-keyshortcuts="l" title="live picture (l)" data-show="live"
                  onClick={() => colors.look_at(null)}>
            <span class="live-thumb" aria-hidden="true">●</span>
            <span>live</span>
          </button>
        </li>
        {images.map(({ id, name, kept }) => {
          const count = samples.filter((sample) => sample.image === id).length;
          return (
            <li key={id}>
              <button type="button" class="frame" aria-pressed={shown.kind === "kept" && shown.id === id} data-image={id}
                      title={`${name}${kept ? "" : "; only in the robot's memory until it is saved with a sample"}`} onClick={() => colors.look_at(id)}>
                <Thumb frame={loaded.get(id) ?? null} />
                <span class="name">{name}{!kept && <span class="mark" aria-label="not saved yet">●</span>}</span>
                <small class="faint">{count === 0 ? "no samples" : `${count} ${count === 1 ? "sample" : "samples"}`}</small>
              </button>
            </li>
          );
        })}
      </ul>
      {shown.kind === "kept" && <SampleList colors={colors} id={shown.id} />}
    </section>
  );
}

const thumb_width = 96;

function Thumb({ frame }: { frame: YuvFrame | null }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    if (frame === null) return;
    const painter = new FramePainter();
    painter.paint({ frame, mode: "picture", opacity: 1, classifier: null, in_use: null });
    canvas.current!.height = Math.max(1, Math.round((thumb_width * frame.height) / frame.width));
    canvas.current!.getContext("2d", { alpha: false })!.drawImage(painter.canvas, 0, 0, canvas.current!.width, canvas.current!.height);
  }, [frame]);
  return <canvas ref={canvas} class="thumb-picture" width={thumb_width} height={72} aria-hidden="true" />;
}

/// A forgotten picture cannot be brought back, so it is asked twice, and not at all while a step of undo may need it.
function Forget({ colors, id }: { colors: ColorsSession; id: string }) {
  const [asked, set_asked] = useState(false);
  useValue(colors.training.view);
  const is_needed = colors.training.needs(id);
  if (!asked) {
    return (
      <button type="button" disabled={is_needed} onClick={() => set_asked(true)}
              title={is_needed ? "samples are drawn in it, or undo could bring some back" : "take it out of the strip"}>
        forget picture
      </button>
    );
  }
  const forget = async (): Promise<void> => {
    if (await colors.training.forget(id)) colors.look_at(null);
  };
  return (
    <span class="row">
      <span>for good?</span>
      <button type="button" class="danger" onClick={() => void forget()}>forget it</button>
      <button type="button" onClick={() => set_asked(false)}>no</button>
    </span>
  );
}

/// Also those that cannot be clicked: masks, and for those who do not use a pointer.
function SampleList({ colors, id }: { colors: ColorsSession; id: string }) {
  const { history } = useValue(colors.training.view);
  const selected = useValue(colors.selected);
  const samples = history.present.samples.filter((sample) => sample.image === id);
  if (samples.length === 0) return null;
  return (
    <details class="samples">
      <summary>{samples.length} {samples.length === 1 ? "sample" : "samples"} in this picture</summary>
      <ul>
        {samples.map((sample, i) => (
          <li key={i} class={sample === selected ? "chosen" : ""}>
            <ClassDot color={sample.class} />
            <button type="button" class="plain" onClick={() => { colors.choose_tool("select"); colors.selected.set(sample); }}>
              {title_of(sample.class)}, {kind_of(sample)}{"mask" in sample ? ` ${sample.mask}` : ""}
            </button>
            <button type="button" class="plain" aria-label={`delete ${kind_of(sample)} of ${title_of(sample.class)}`} onClick={() => colors.remove(sample)}>delete</button>
          </li>
        ))}
      </ul>
    </details>
  );
}
