import { ask } from "../link/api";
import { Observable } from "../link/observable";

/// How it stands with recording, as /api/recording and /api/state tell.
export interface Recording {
  on: boolean;
  finishing: boolean;
  /// Below which recordings are made.
  folder: string;
  /// Of the newest part in there; empty: none yet.
  name: string;
  parts: number;
  seconds: number;
  frames: number;
  bytes: number;
  dropped: number;
  trouble: string;
}

export interface RecordingView {
  /// Null: the server has told nothing yet, or does not record.
  readonly recording: Recording | null;
  /// What was pressed is on its way.
  readonly pending: boolean;
  /// Why it was refused.
  readonly refusal: string;
}

export type PutRecording = (on: boolean) => Promise<Recording>;

const put: PutRecording = (on) =>
  ask("/api/recording", { method: "PUT", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ on }) });

/// The button, and what it did.
export class RecordingModel {
  readonly view = new Observable<RecordingView>({ recording: null, pending: false, refusal: "" });

  constructor(private readonly record: PutRecording = put) {}

  /// What the server says by itself is older than what is asked for at the moment.
  told(recording: Recording | null): void {
    if (!this.view.value.pending) this.update({ recording });
  }

  async toggle(): Promise<void> {
    const { recording, pending } = this.view.value;
    if (recording === null || pending) return;
    this.update({ pending: true, refusal: "" });
    try {
      this.update({ recording: await this.record(!recording.on), pending: false });
    } catch (error) {
      this.update({ pending: false, refusal: error instanceof Error ? error.message : String(error) });
    }
  }

  private update(change: Partial<RecordingView>): void {
    this.view.set({ ...this.view.value, ...change });
  }
}

/// "0:07", "12:03", "1:02:03".
export function duration(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  const two = (value: number): string => String(value).padStart(2, "0");
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  return hours > 0 ? `${hours}:${two(minutes)}:${two(whole % 60)}` : `${minutes}:${two(whole % 60)}`;
}

/// Of the newest part: "recordings/2026-11-28T00-04-47Z", or only the folder while there is none.
export function place(recording: Recording): { short: string; full: string } {
  const folder = recording.folder.split("/").pop() || recording.folder;
  return recording.name === ""
    ? { short: folder, full: recording.folder }
    : { short: `${folder}/${recording.name}`, full: `${recording.folder}/${recording.name}` };
}

/// How it stands, in words that change only when something happened; numbers stand beside them.
export function words(recording: Recording): string {
  if (recording.on) return "recording";
  if (recording.finishing) return "writing the last frames";
  if (recording.trouble !== "") return "ended by itself";
  return recording.name === "" ? "not recording" : "recorded";
}
