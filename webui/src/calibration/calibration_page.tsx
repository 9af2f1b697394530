import { useEffect } from "preact/hooks";
import { useValue } from "../link/observable";
import type { Session } from "../session";
import "../colors/colors.css";
import "./calibration.css";
import type { CalibrationSession } from "./calibration_session";
import { key_help, press } from "./keys";
import { PicturePane } from "./picture_pane";
import { ResultPane } from "./result_pane";
import { LensPane, TargetPane } from "./target_pane";
import { ViewsPane } from "./views_pane";

/// Camera calibration: hold a target in front of the camera, look at what is covered, work the camera out, keep it.
export function CalibrationPage({ session }: { session: Session }) {
  const { calibration } = session;
  useEffect(() => {
    calibration.open();
    session.want_pictures(false);
    const key = (event: KeyboardEvent): void => {
      if (!event.defaultPrevented && press(calibration, event)) event.preventDefault();
    };
    addEventListener("keydown", key);
    return () => {
      removeEventListener("keydown", key);
      session.want_pictures(true);
      calibration.close();
    };
  }, [session]);
  return (
    <div class="calibration">
      <h1 class="unseen">Calibration</h1>
      <Words session={calibration} />
      <div class="work">
        <PicturePane session={calibration} />
        <ViewsPane session={calibration} />
      </div>
      <div class="judge">
        <TargetPane session={calibration} />
        <LensPane session={calibration} />
        <ResultPane session={calibration} />
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
function Words({ session }: { session: CalibrationSession }) {
  const { trouble, refusal } = useValue(session.model.view);
  const said = useValue(session.said);
  return (
    <div class="words">
      {trouble && <p class="notice" role="alert" data-show="trouble">{trouble}</p>}
      {refusal && (
        <p class="notice warning" role="alert" data-show="refusal">
          <span>not done: {refusal}</span>
          <button type="button" onClick={() => session.model.dismiss()}>understood</button>
        </p>
      )}
      <span class="unseen" role="status">{said}</span>
    </div>
  );
}
