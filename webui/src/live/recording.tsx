import { count, fixed } from "../format";
import { useValue } from "../link/observable";
import type { Session } from "../session";
import { duration, place, words } from "./recording_model";

/// Begins and ends a recording, from which the same scenes come again, and tells how it stands.
export function RecordingBar({ session }: { session: Session }) {
  const { recording, pending, refusal } = useValue(session.recording.view);
  if (recording === null) return null;
  const { on, frames, dropped, parts, trouble } = recording;
  const where = place(recording);
  const has_begun = on || recording.finishing || recording.name !== "";
  return (
    <section class="recording" data-show="recording" data-on={on}>
      <h2 class="unseen">Recording</h2>
      <button type="button" class="record" aria-pressed={on} disabled={pending} onClick={() => void session.recording.toggle()}>
        <span class="mark" aria-hidden="true" />
        {on ? "Stop recording" : "Record"}
      </button>
      <p>
        <span role="status">{words(recording)}</span>
        {has_begun && (
          <>
            {" "}
            <span class="number" data-show="recording-time">{duration(recording.seconds)}</span>,{" "}
            <span class="number"><span data-show="recording-frames">{count(frames)}</span> frames</span>,{" "}
            <span class="number">{fixed(recording.bytes / 1e6, 1)}&nbsp;MB</span>
            {parts > 1 && <>, <span class="number">{parts} parts</span></>}
          </>
        )}
        {" "}
        <span class="faint">{has_begun ? "in" : "– video, odometry and scenes, to be seen again; into"}{" "}
          <code title={where.full} data-show="recording-place">{where.short}</code>
        </span>
      </p>
      {dropped > 0 && <p class="bad" data-show="recording-dropped">{count(dropped)} frames not recorded, the disk was too slow</p>}
      {(refusal || trouble) && <p class="error" role="alert" data-show="recording-trouble">{refusal || trouble}</p>}
    </section>
  );
}
