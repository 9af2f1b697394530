import { useEffect, useRef } from "preact/hooks";
import { useValue } from "../link/observable";
import type { Interval } from "./classify";
import { css_color, label_of, line_color, type Rgb, title_of } from "./color_class";
import type { ColorsSession } from "./colors_session";
import { with_brightness } from "./draft";

/// One end of the interval moved: it stays within 0..255 and never passes the other.
export function moved_end([low, high]: Interval, end: 0 | 1, to: number): Interval {
  const value = Math.round(to);
  return end === 0 ? [Math.min(Math.max(value, 0), high), high] : [low, Math.max(Math.min(value, 255), low)];
}

/// How far a key moves an end; null for other keys.
export function key_target(key: string, value: number): number | null {
  const steps: Record<string, number> = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10, Home: -255, End: 255 };
  const step = steps[key];
  return step === undefined ? null : value + step;
}

const ends = [0, 1] as const;

/// The brightness of the chosen class: its histogram, and the interval as two thumbs on it.
export function Brightness({ colors }: { colors: ColorsSession }) {
  const { training } = colors;
  const { result, color, history } = useValue(training.view);
  const probe = useValue(colors.probe);
  const track = useRef<HTMLDivElement>(null);
  /// The end that is dragged.
  const drag = useRef<0 | 1 | null>(null);
  const by_hand = history.present.brightness[color];
  const interval = by_hand ?? result?.table.brightness[color] ?? null;
  const counts = result?.seen?.class === color ? result.seen.brightness : null;
  if (color === "no_color") return <p class="faint">no color has no brightness: its samples only take cells away from the others</p>;

  const set = (next: Interval, end: 0 | 1, time: number): void => {
    if (interval !== null && next[0] === interval[0] && next[1] === interval[1]) return;
    training.edit(with_brightness(training.draft, color, next), `brightness of ${title_of(color)}`, `brightness ${color} ${end}`, time);
  };
  const value_at = (event: PointerEvent): number => {
    const box = track.current!.getBoundingClientRect();
    return (255 * (event.clientX - box.left)) / box.width;
  };
  const down = (event: PointerEvent): void => {
    if (interval === null) return;
    event.preventDefault();
    track.current!.setPointerCapture(event.pointerId);
    const value = value_at(event);
    // Of two thumbs at one place, the one that can go there.
    drag.current = Math.abs(value - interval[0]) < Math.abs(value - interval[1]) || (interval[0] === interval[1] && value < interval[0]) ? 0 : 1;
    (track.current!.querySelectorAll("[role=slider]")[drag.current] as HTMLElement).focus({ preventScroll: true });
    training.end_gesture();
    set(moved_end(interval, drag.current, value), drag.current, event.timeStamp);
  };
  const move = (event: PointerEvent): void => {
    if (drag.current !== null && interval !== null) set(moved_end(interval, drag.current, value_at(event)), drag.current, event.timeStamp);
  };
  const up = (): void => {
    drag.current = null;
    training.end_gesture();
  };
  const key = (event: KeyboardEvent, end: 0 | 1): void => {
    const to = interval === null ? null : key_target(event.key, interval[end]);
    if (to === null || event.ctrlKey || event.altKey) return;
    event.preventDefault();
    set(moved_end(interval!, end, to), end, event.timeStamp);
  };

  return (
    <div class="brightness">
      <header>
        <h3>Brightness Y</h3>
        <span>
          {interval === null ? <span class="faint">no samples yet</span> : <span data-show="interval">{interval[0]} to {interval[1]}</span>}
          {interval !== null && <small class={by_hand ? "mark" : "faint"}> {by_hand ? "by hand" : "trained"}</small>}
          <button type="button" class="plain" disabled={by_hand === undefined} title="back to the trained brightness"
                  onClick={() => training.edit(with_brightness(training.draft, color, null), `brightness of ${title_of(color)} trained again`)}>
            reset
          </button>
        </span>
      </header>
      <div ref={track} class="track" onPointerDown={down} onPointerMove={move} onPointerUp={up} onPointerCancel={up}>
        {interval !== null && <div class="span" style={{ left: `${(100 * interval[0]) / 255}%`, width: `${(100 * (interval[1] - interval[0])) / 255}%` }} />}
        <Histogram counts={counts} interval={interval} color={css_color(bar_color(label_of(color)))} />
        {probe !== null && <div class="mark-line" style={{ left: `${(100 * probe.y) / 255}%` }} />}
        {interval !== null && ends.map((end) => (
          <div key={end} role="slider" tabIndex={0} class={`thumb ${end === 0 ? "low" : "high"}`} style={{ left: `${(100 * interval[end]) / 255}%` }}
               aria-label={`${end === 0 ? "lowest" : "highest"} brightness of ${title_of(color)}`} aria-valuemin={end === 0 ? 0 : interval[0]}
               aria-valuemax={end === 0 ? interval[1] : 255} aria-valuenow={interval[end]} data-show={end === 0 ? "brightness-low" : "brightness-high"}
               onKeyDown={(event) => key(event, end)} onBlur={() => training.end_gesture()} />
        ))}
      </div>
    </div>
  );
}

/// Seen on a light and a dark ground.
function bar_color(label: number): Rgb {
  return label === label_of("white") ? [170, 178, 186] : line_color(label);
}

interface HistogramProps {
  counts: readonly number[] | null;
  interval: Interval | null;
  color: string;
}

/// By the square root, so that rare ones are seen too; faint outside of the interval.
function Histogram({ counts, interval, color }: HistogramProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const element = canvas.current!;
    const context = element.getContext("2d")!;
    context.clearRect(0, 0, 512, 128);
    const most = Math.max(...(counts ?? []), 1);
    counts?.forEach((count, y) => {
      if (count === 0) return;
      const height = Math.max(120 * Math.sqrt(count / most), 3);
      context.globalAlpha = interval !== null && interval[0] <= y && y <= interval[1] ? 1 : 0.35;
      context.fillStyle = color;
      context.fillRect(2 * y, 128 - height, 2, height);
    });
    context.globalAlpha = 1;
  }, [counts, interval?.[0], interval?.[1], color]);
  return <canvas ref={canvas} width={512} height={128} role="img" aria-label="how many pixels have which brightness" data-show="histogram" />;
}
