import { useEffect, useState } from "preact/hooks";
import { CalibrationPage } from "./calibration/calibration_page";
import { ColorsPage } from "./colors/colors_page";
import { LiveView } from "./live/live_view";
import { changed_keys } from "./stages/model";
import { StagesPage } from "./stages/stages_page";
import { useValue } from "./link/observable";
import type { Session } from "./session";

const views = [
  { id: "live", title: "Live" },
  { id: "stages", title: "Stages" },
  { id: "colors", title: "Colors" },
  { id: "calibration", title: "Calibration" },
] as const;
type View = (typeof views)[number]["id"];

function view_of_address(): View {
  return views.find((view) => location.hash === `#/${view.id}`)?.id ?? "live";
}

export function App({ session }: { session: Session }) {
  const [view, set_view] = useState<View>(view_of_address);
  useEffect(() => {
    const follow = (): void => set_view(view_of_address());
    addEventListener("hashchange", follow);
    return () => removeEventListener("hashchange", follow);
  }, []);
  useEffect(() => {
    document.title = `${views.find((v) => v.id === view)!.title} · Tassilo`;
  }, [view]);

  return (
    <>
      <header class="bar">
        <span class="brand">Tassilo</span>
        <nav aria-label="Views">
          {views.map(({ id, title }) => (
            <a key={id} href={`#/${id}`} aria-current={view === id ? "page" : undefined}>
              {title}
              {id === "stages" && <ChangedBadge session={session} />}
              {id === "colors" && <UnsavedBadge session={session} />}
              {id === "calibration" && <UnsavedResultBadge session={session} />}
            </a>
          ))}
        </nav>
        <ConditionChip session={session} />
        <FreezeButton session={session} />
      </header>
      <Notices session={session} />
      <Content session={session} view={view} />
    </>
  );
}

/// What is shown while the connection is lost is from before; it must not look as if it were now.
function Content({ session, view }: { session: Session; view: View }) {
  const lost = useValue(session.condition).tone === "bad";
  return (
    <main class={lost ? "old" : undefined} data-show="content">
      {view === "live" && <LiveView session={session} />}
      {view === "stages" && <StagesPage session={session} />}
      {view === "colors" && <ColorsPage session={session} />}
      {view === "calibration" && <CalibrationPage session={session} />}
    </main>
  );
}

function ChangedBadge({ session }: { session: Session }) {
  const { stages } = useValue(session.stages.view);
  const changed = changed_keys(stages ?? []).length;
  return changed === 0 ? null : <span class="badge" aria-label={`${changed} changed`}>{changed}</span>;
}

function UnsavedBadge({ session }: { session: Session }) {
  const { training, is_saved } = useValue(session.colors.training.view);
  return training === null || is_saved ? null : <NotSaved />;
}

function UnsavedResultBadge({ session }: { session: Session }) {
  const { calibration } = useValue(session.calibration.model.view);
  return calibration === null || calibration.result === null || calibration.file.is_saved ? null : <NotSaved />;
}

function NotSaved() {
  return <span class="badge" role="img" aria-label="not saved" title="not saved">●</span>;
}

function ConditionChip({ session }: { session: Session }) {
  const condition = useValue(session.condition);
  return (
    <span class={`chip ${condition.tone}`}>
      <span class="dot" aria-hidden="true" />
      <span aria-hidden="true" data-show="condition">{condition.text}</span>
      {/* Read aloud when it changes, which the seconds to the next try are not worth. */}
      <span class="unseen" role="status">{condition.text.replace(/\d+ s$/, "some seconds")}</span>
      {condition.text.startsWith("connection lost") && (
        <button type="button" class="plain" onClick={() => session.retry()}>try now</button>
      )}
    </span>
  );
}

function FreezeButton({ session }: { session: Session }) {
  const frozen = useValue(session.live.frozen);
  return (
    <button type="button" class="freeze" aria-pressed={frozen} aria-keyshortcuts="Space" title="or the space key"
            onClick={() => session.toggle_freeze()}>
      {frozen ? "Continue" : "Freeze"}
    </button>
  );
}

/// What spoils all that is seen is told on every view: a changed configuration that was refused, a camera that has moved, no picture.
function Notices({ session }: { session: Session }) {
  const state = useValue(session.server);
  if (state === null) return null;
  const notices = [
    state.configuration.refusal && `configuration refused, the one before goes on: ${state.configuration.refusal}`,
    state.mount_drift && `the camera's mount has drifted from its file: ${state.mount_drift}; tassilo calibrate mount measures it`,
    state.picture_fault && `no picture: ${state.picture_fault}`,
  ].filter((notice) => notice);
  return <>{notices.map((notice) => <p key={notice} class="notice" role="alert">{notice}</p>)}</>;
}
