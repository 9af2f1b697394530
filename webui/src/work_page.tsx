import { useEffect } from "preact/hooks";
import type { Session } from "./session";

// What pages have in common on which people work rather than look.

/// While the page is shown, its own session is open, annotated pictures are not wanted, and keys are its own. `press` tells whether a key was one of them.
export function useWork<Work extends { open(): void; close(): void }>(session: Session, work: Work, press: (work: Work, event: KeyboardEvent) => boolean): void {
  useEffect(() => {
    work.open();
    session.want_pictures(false);
    const key = (event: KeyboardEvent): void => {
      if (!event.defaultPrevented && press(work, event)) event.preventDefault();
    };
    addEventListener("keydown", key);
    return () => {
      removeEventListener("keydown", key);
      session.want_pictures(true);
      work.close();
    };
  }, [session]);
}

export function KeyHelp({ keys }: { keys: readonly (readonly [string, string])[] }) {
  return (
    <section class="help" aria-label="Keys">
      <details>
        <summary>Keys</summary>
        <dl>{keys.map(([key, what]) => <div key={key}><dt><kbd>{key}</kbd></dt><dd>{what}</dd></div>)}</dl>
      </details>
    </section>
  );
}

interface WordsProps {
  /// What keeps the page from working.
  trouble: string;
  /// What was not done or is not as it was; stays until it is understood.
  notice: string;
  /// Name of the notice for tests.
  show: string;
  dismiss: () => void;
  /// Only read aloud.
  said: string;
}

/// What must be read before anything else.
export function Words({ trouble, notice, show, dismiss, said }: WordsProps) {
  return (
    <div class="words">
      {trouble && <p class="notice" role="alert" data-show="trouble">{trouble}</p>}
      {notice && (
        <p class="notice warning" role="alert" data-show={show}>
          <span>{notice}</span>
          <button type="button" onClick={dismiss}>understood</button>
        </p>
      )}
      <span class="unseen" role="status">{said}</span>
    </div>
  );
}
