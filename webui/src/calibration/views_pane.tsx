import { useState } from "preact/hooks";
import { fixed } from "../format";
import { useValue } from "../link/observable";
import type { CalibrationSession } from "./calibration_session";

/// The views that were captured, what the result says of each, and its points when it is pointed at.
export function ViewsPane({ session }: { session: CalibrationSession }) {
  const { calibration } = useValue(session.model.view);
  const pointed = useValue(session.pointed);
  const views = calibration?.views ?? [];
  const rejected = views.filter((view) => view.rejected !== "").length;
  const point = (id: string | null) => (): void => session.pointed.set(id);
  return (
    <section class="views" aria-label="Views">
      <header>
        <h2>Views</h2>
        <span class="faint">{views.length === 0 ? "none yet" : rejected === 0 ? views.length : `${views.length}, ${rejected} thrown out`}</span>
        {views.length > 0 && <ForgetAll session={session} count={views.length} />}
      </header>
      {views.length === 0
        ? <p class="faint">Hold the target still, then move it: near and far, tilted by 20° to 45°, and into each corner of the picture. Ten views or more are good.</p>
        : (
          <ul data-show="views" onPointerLeave={point(null)}>
            {views.map(({ id, frame, target, points, rms_px, rejected: why }) => (
              <li key={id} data-view={id} class={`${id === pointed ? "chosen" : ""} ${why === "" ? "" : "rejected"}`} onPointerEnter={point(id)} onFocusIn={point(id)} onFocusOut={point(null)}>
                <button type="button" class="view" title={`frame ${frame}, ${target}; its points are shown in the picture`} onClick={point(id)}>
                  <b>{id}</b>
                  <span class="number">{rms_px === null ? <span class="faint">{points.length} points</span> : `${fixed(rms_px, 2)}\u00a0px`}</span>
                  {why !== "" && <span class="why-not">thrown out: {why}</span>}
                </button>
                <button type="button" class="plain" aria-label={`forget view ${id}`} onClick={() => void session.forget(id)}>forget</button>
              </li>
            ))}
          </ul>
        )}
    </section>
  );
}

/// What is forgotten cannot be brought back, so it is asked twice.
function ForgetAll({ session, count }: { session: CalibrationSession; count: number }) {
  const [asked, set_asked] = useState(false);
  if (!asked) return <button type="button" class="plain" data-show="forget-all" onClick={() => set_asked(true)}>forget all</button>;
  const forget = async (): Promise<void> => {
    set_asked(false);
    await session.forget_all();
  };
  return (
    <span class="row">
      <span>all {count}?</span>
      <button type="button" class="danger" onClick={() => void forget()}>forget them</button>
      <button type="button" onClick={() => set_asked(false)}>no</button>
    </span>
  );
}
