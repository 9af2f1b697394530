import { useEffect, useRef, useState } from "preact/hooks";
import { useValue } from "../link/observable";
import { CalibrationCanvas } from "./calibration_canvas";
import type { CalibrationSession } from "./calibration_session";
import { missing_places } from "./coverage";
import { verdict_of, why_not_solved } from "./verdict";

/// Begin and end, the verdict on what the camera sees, and the live picture: all that is needed while the target is held.
export function PicturePane({ session }: { session: CalibrationSession }) {
  const pane = useRef<HTMLElement>(null);
  const view = useValue(session.model.view);
  const is_full = useIsFull(pane);
  const { calibration, captured, pending, wanted } = view;
  const is_on = calibration?.is_on ?? false;
  const why = why_not_solved(view);
  const begin = async (): Promise<void> => {
    // On a telephone the field that is wrong may be out of sight.
    if (!(await session.begin())) document.querySelector<HTMLElement>('.targets [aria-invalid="true"]')?.focus();
  };
  return (
    <section ref={pane} class={`at-work ${is_full ? "full" : ""}`} aria-label="Capture">
      <div class="row controls">
        <button type="button" class={is_on ? "" : "primary"} disabled={calibration === null || pending.includes("change")} data-show="begin"
                onClick={() => void (is_on ? session.end() : begin())}>
          {is_on ? "End" : "Begin"}
        </button>
        <label class="inline">
          <input type="checkbox" checked={wanted.is_automatic ?? calibration?.is_automatic ?? false} disabled={calibration === null} data-show="automatic"
                 onChange={(event) => void session.model.change({ is_automatic: event.currentTarget.checked })} />
          capture good views by themselves
        </label>
        <button type="button" disabled={!is_on || pending.includes("capture")} aria-keyshortcuts="c" title="the next frame, however alike the views are (c)" data-show="capture"
                onClick={() => void session.capture()}>
          Capture now
        </button>
        <button type="button" class={is_on && (calibration?.views.length ?? 0) > 0 ? "primary" : ""} disabled={why !== ""} aria-keyshortcuts="s" title={why || "work the camera out from the views, and capture no more by themselves (s)"}
                data-show="solve" onClick={() => void session.solve()}>
          Solve
        </button>
        {document.fullscreenEnabled && (
          <button type="button" class="fill" aria-keyshortcuts="f" aria-pressed={is_full} title="to be read from afar (f)" data-show="full" onClick={() => toggle_full(pane.current!)}>
            {is_full ? "Small again" : "Large"}
          </button>
        )}
      </div>
      <VerdictBoard session={session} />
      <div class={`stage-of-picture ${captured !== null ? "captured" : ""}`}>
        <Picture session={session} />
        {captured !== null && <span key={captured} class="flash" aria-hidden="true" />}
      </div>
      <Legend session={session} />
    </section>
  );
}

function toggle_full(pane: HTMLElement): void {
  if (document.fullscreenElement === null) void pane.requestFullscreen().catch(() => {});   // where it is not allowed, the page stays as it is
  else void document.exitFullscreen();
}

function useIsFull(pane: { readonly current: HTMLElement | null }): boolean {
  const [is_full, set] = useState(false);
  useEffect(() => {
    const follow = (): void => set(document.fullscreenElement !== null && document.fullscreenElement === pane.current);
    document.addEventListener("fullscreenchange", follow);
    return () => document.removeEventListener("fullscreenchange", follow);
  }, []);
  return is_full;
}

/// A verdict that holds for so long is read aloud; at work they change several times a second. [ms]
const spoken_after_ms = 1200;
/// With more letters than this the letters are smaller.
const long_verdict = 30;

function VerdictBoard({ session }: { session: CalibrationSession }) {
  const view = useValue(session.model.view);
  const { text, detail, tone } = verdict_of(view);
  const [spoken, set_spoken] = useState("");
  useEffect(() => {
    const timer = setTimeout(() => set_spoken(text), tone === "good" ? 0 : spoken_after_ms);
    return () => clearTimeout(timer);
  }, [text, tone]);
  const { calibration } = view;
  const views = calibration?.views.length ?? 0;
  return (
    <div class={`verdict ${tone}`} data-tone={tone}>
      <p class={text.length > long_verdict ? "long" : ""} aria-hidden="true" data-show="verdict">{text}</p>
      {detail !== "" && <p class="detail" aria-hidden="true" data-show="verdict-detail" title={detail}>{detail}</p>}
      <p class="so-far">
        <b data-show="view-count">{views}</b> {views === 1 ? "view" : "views"}
        <span> · <b data-show="share">{Math.round(100 * (calibration?.coverage.share ?? 0))}</b>&nbsp;% covered</span>
      </p>
      <span class="unseen" role="status" aria-live="polite" data-show="spoken">{spoken}</span>
    </div>
  );
}

function Picture({ session }: { session: CalibrationSession }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const there = useValue(session.frames.newest) !== null;
  useEffect(() => {
    const drawn = new CalibrationCanvas(canvas.current!, session);
    return () => drawn.end();
  }, [session]);
  return (
    <>
      <canvas ref={canvas} width={640} height={480} role="img" aria-label="live picture in gray, with the points found, where points have been, and the views" data-show="calibration-picture" />
      {!there && <p class="no-picture">no picture yet</p>}
    </>
  );
}

function Legend({ session }: { session: CalibrationSession }) {
  const { calibration } = useValue(session.model.view);
  const coverage = useValue(session.shows_coverage);
  const outlines = useValue(session.shows_outlines);
  const missing = calibration === null || calibration.views.length === 0 ? "" : missing_places(calibration.coverage);
  return (
    <div class="row legend">
      <label class="inline"><input type="checkbox" checked={coverage} onChange={(event) => session.shows_coverage.set(event.currentTarget.checked)} />coverage</label>
      <span class="faint"><span class="key missing" /> missing <span class="key few" /> few points <span class="key many" /> many</span>
      <label class="inline">
        <input type="checkbox" checked={outlines} data-show="outlines" onChange={(event) => session.shows_outlines.set(event.currentTarget.checked)} />outlines of views
      </label>
      {missing !== "" && <span class="where" data-show="missing">not covered yet: <b>{missing}</b> of the picture</span>}
    </div>
  );
}
