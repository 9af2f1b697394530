import { useValue } from "../link/observable";
import type { Session } from "../session";
import { KeyHelp, useWork, Words } from "../work_page";
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
  useWork(session, calibration, press);
  return (
    <div class="calibration">
      <h1 class="unseen">Calibration</h1>
      <CalibrationWords session={calibration} />
      <div class="work">
        <PicturePane session={calibration} />
        <ViewsPane session={calibration} />
      </div>
      <div class="judge">
        <TargetPane session={calibration} />
        <LensPane session={calibration} />
        <ResultPane session={calibration} />
        <KeyHelp keys={key_help} />
      </div>
    </div>
  );
}

function CalibrationWords({ session }: { session: CalibrationSession }) {
  const { trouble, refusal } = useValue(session.model.view);
  const said = useValue(session.said);
  return <Words trouble={trouble} notice={refusal && `not done: ${refusal}`} show="refusal" dismiss={() => session.model.dismiss()} said={said} />;
}
