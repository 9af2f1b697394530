import { useEffect, useState } from "preact/hooks";
import { reason } from "../link/api";
import { fixed } from "../format";
import type { CalibrationResult } from "../link/calibration_api";
import { useValue } from "../link/observable";
import type { CalibrationSession } from "./calibration_session";
import { why_not_kept, with_sigma } from "./verdict";

/// What was worked out, how far it can be trusted, and keeping it.
export function ResultPane({ session }: { session: CalibrationSession }) {
  const view = useValue(session.model.view);
  const { calibration, results } = view;
  if (calibration === null) return null;
  const { result, failure, is_solving, file } = calibration;
  const why = why_not_kept(view);
  return (
    <section class="result" aria-label="Result" aria-busy={is_solving}>
      <header>
        <h2>Result</h2>
        <span class={result !== null && !file.is_saved ? "mark" : "faint"} data-show="saved">
          {is_solving ? "being worked out" : result === null ? "none yet" : file.is_saved ? "saved" : "not saved"}
        </span>
      </header>
      {failure !== "" && <p class="notice" role="alert" data-show="failure">the camera cannot be worked out: {failure}</p>}
      {result !== null && <Numbers result={result} />}
      {result !== null && <Residuals key={results} session={session} />}
      <div class="row keep">
        <button type="button" class="primary" disabled={why !== ""} aria-keyshortcuts="Control+s" title={why || "save (Ctrl+S)"} data-show="save" onClick={() => void session.save()}>
          Save and use
        </button>
        {why !== "" && <span class="faint" data-show="why-not-saved">{why}</span>}
      </div>
      <p class="under faint">
        Writes <code>{file.camera}</code> with the mount it has, which is kept, and the robot sees with it at once. The file before stays beside it.
      </p>
    </section>
  );
}

const value_meanings: Readonly<Record<string, string>> = {
  fx: "focal length, across [px]", fy: "focal length, down [px]", cx: "principal point, across [px]", cy: "principal point, down [px]",
  p1: "tangential", p2: "tangential", k: "distortion", k1: "radial", k2: "radial", k3: "radial", k4: "radial",
};

function Numbers({ result }: { result: CalibrationResult }) {
  const { rms_px, cross_validated_rms_px, worst_sigma_px, values, warnings, views, model } = result;
  return (
    <>
      {warnings.length > 0 && (
        <ul class="warnings" role="alert" data-show="warnings">{warnings.map((warning, i) => <li key={i}>{warning}</li>)}</ul>
      )}
      <dl class="tiles three">
        <div>
          <dt>RMS</dt><dd><span data-show="rms">{fixed(rms_px, 3)}</span> <small>px</small></dd>
          <dd class="meaning">how far points lie from where this camera shows them. Small: the lens model bends enough, not yet that it is right.</dd>
        </div>
        <div>
          <dt>RMS of views left out</dt><dd><span data-show="cross-validated">{fixed(cross_validated_rms_px, 3)}</span> <small>px</small></dd>
          <dd class="meaning">{cross_validated_rms_px === null ? "cannot be told, there are too few views."
            : "the same for views that it was not worked out from. Much more than the RMS: more and other views are needed."}</dd>
        </div>
        <div>
          <dt>Worst place</dt><dd><span data-show="worst-sigma">{worst_sigma_px === null ? "?" : `±\u00a0${fixed(worst_sigma_px, 2)}`}</span> <small>px</small></dd>
          <dd class="meaning">{worst_sigma_px === null ? "how uncertain directions are cannot be told." : "where directions are known worst in the image, mostly where no target was held."}</dd>
        </div>
      </dl>
      <table data-show="values">
        <thead><tr><th>{model}, {views} {views === 1 ? "view" : "views"}</th><th class="number">value</th><th class="number">σ</th></tr></thead>
        <tbody>
          {values.map(({ name, value, sigma }) => {
            const shown = with_sigma(value, sigma);
            return (
              <tr key={name}>
                <th><code>{name}</code> <small class="faint">{value_meanings[name] ?? ""}</small></th>
                <td class="number">{shown.value}</td><td class="number">±&nbsp;{shown.sigma}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
      <p class="under faint">
        σ is one standard deviation, from how the points scatter: two times in three the true value is that near, if the lens is one of this model and the target is flat.
        A bent target makes values wrong without making σ larger.
      </p>
    </>
  );
}

/// Of one result; another one has a picture of its own.
function Residuals({ session }: { session: CalibrationSession }) {
  const [shown, set_shown] = useState<{ address: string } | { why: string } | null>(null);
  useEffect(() => {
    let address = "", ended = false;
    session.model.residuals().then((blob) => {
      if (ended) return;
      address = URL.createObjectURL(blob);
      set_shown({ address });
    }, (error: unknown) => set_shown({ why: reason(error) }));
    return () => {
      ended = true;
      URL.revokeObjectURL(address);
    };
  }, [session]);
  if (shown === null) return <p class="under faint">the picture of the residuals comes</p>;
  if ("why" in shown) return <p class="error" data-show="no-residuals">no picture of the residuals: {shown.why}</p>;
  return (
    <figure class="residuals">
      <a href={shown.address} target="_blank" rel="noopener" title="in full size">
        <img src={shown.address} alt="residuals: how far each point lies from where the camera shows it" data-show="residuals" />
      </a>
      <figcaption class="under faint">Residuals, enlarged. They should look like noise: arrows that go together tell of a lens model that does not fit, or of a bent target.</figcaption>
    </figure>
  );
}
