import { useState } from "preact/hooks";
import { useValue } from "../link/observable";
import { age_words, clock_words, type Span, speeds } from "./moment";
import type { MonitorSession } from "./monitor_session";

/// When it is: what can be looked back at, and how it is played.
export function TimeBar({ session }: { session: MonitorSession }) {
  const time = useValue(session.time);
  // While it is dragged, what is under the pointer must not slide away.
  const [held, set_held] = useState<Span | null>(null);
  const mode = time?.mode ?? "live";
  const moment = time?.moment;
  const span = held ?? time?.span ?? { begin: 0, end: 1 };
  const is_live = moment?.is_live ?? false;
  const off = !(time?.can_look_back ?? false);
  return (
    <div class={`time-bar-row ${mode === "live" && moment !== undefined && !is_live ? "past" : ""}`} role="group" aria-label="Time" data-show="time">
      <div class="play">
        <button type="button" disabled={off} aria-label="one picture back" title="one picture back (←)" onClick={() => session.step(-1)}>‹</button>
        <button type="button" class="play-button" disabled={off} title="or the space key" data-show="play" onClick={() => session.toggle_play()}>
          {moment?.playing ?? true ? "Pause" : "Play"}
        </button>
        <button type="button" disabled={off || is_live} aria-label="one picture on" title="one picture on (→)" onClick={() => session.step(1)}>›</button>
        <select aria-label="speed" title="speed (< >)" disabled={off || is_live} value={moment?.speed ?? 1} data-show="speed"
                onChange={(event) => {
                  session.set_speed(Number(event.currentTarget.value));
                  event.currentTarget.blur();   // arrows step through time again
                }}>
          {speeds.map((speed) => <option key={speed} value={speed}>{speed}×</option>)}
        </select>
      </div>
      <input type="range" class="scrubber" step="any" min={span.begin} max={span.end} value={is_live ? span.end : (moment?.t ?? span.end)} disabled={off} aria-label="time"
             aria-valuetext={time ? `${clock_words(time.moment.t)}, ${age_words(time.moment, mode, time.span, time.silence)}` : undefined} data-show="scrubber"
             onPointerDown={() => set_held(span)} onPointerUp={() => set_held(null)} onPointerCancel={() => set_held(null)} onLostPointerCapture={() => set_held(null)}
             onInput={(event) => session.seek(Number(event.currentTarget.value))} />
      <div class="now">
        <b data-show="clock">{moment ? clock_words(moment.t) : "–"}</b>
        <span class="faint" data-show="age">{time ? age_words(time.moment, mode, time.span, time.silence) : ""}</span>
      </div>
      {mode === "live" && (
        <button type="button" class="live-button" aria-pressed={is_live} title="back to live (l)" data-show="live" disabled={off} onClick={() => session.to_end()}>Live</button>
      )}
    </div>
  );
}
