import { type CalibrationApi, server_calibration } from "../link/calibration_api";
import { Observable } from "../link/observable";
import { CalibrationModel } from "./calibration_model";
import { LiveFrames } from "./live_frames";
import { TargetEditor } from "./target_editor";
import { why_not_kept, why_not_solved } from "./verdict";

/// The calibration page, for as long as the program's page is open: leaving it for another view loses nothing.
export class CalibrationSession {
  readonly model: CalibrationModel;
  readonly targets: TargetEditor;
  readonly frames: LiveFrames;
  /// The view whose points are shown.
  readonly pointed = new Observable<string | null>(null);
  readonly shows_coverage = new Observable(true);
  readonly shows_outlines = new Observable(true);
  /// What just happened, for those who do not see it.
  readonly said = new Observable("");
  private is_open = false;

  constructor(frozen: Observable<boolean>, api: CalibrationApi = server_calibration) {
    this.model = new CalibrationModel(api, {
      now: () => performance.now(),
      after: (ms, call) => {
        const timer = setTimeout(call, ms);
        return () => clearTimeout(timer);
      },
    });
    this.frames = new LiveFrames(frozen);
    this.targets = new TargetEditor((targets) => this.model.change({ targets }));
    this.model.view.subscribe(() => {
      const { calibration } = this.model.view.value;
      if (calibration === null) return;
      this.targets.told(calibration.targets);
      const { value } = this.pointed;
      if (value !== null && !calibration.views.some(({ id }) => id === value)) this.pointed.set(null);
    });
    // Nobody looks: neither frames nor questions are worth the radio link.
    document.addEventListener("visibilitychange", () => this.follow());
  }

  open(): void {
    this.is_open = true;
    this.follow();
  }

  close(): void {
    this.is_open = false;
    this.pointed.set(null);
    this.follow();
  }

  retry(): void {
    this.frames.retry();
  }

  /// With the targets as they are typed. Those that are none, or are refused, are told, and it does not begin.
  async begin(): Promise<boolean> {
    if (await this.targets.commit()) return this.model.change({ is_on: true });
    this.said.set("not begun: a target is wrong");
    return false;
  }

  async end(): Promise<void> {
    await this.model.change({ is_on: false });
  }

  async capture(): Promise<void> {
    const { calibration, pending } = this.model.view.value;
    if (calibration?.is_on && !pending.includes("capture")) await this.model.capture();
  }

  async solve(): Promise<void> {
    const why = why_not_solved(this.model.view.value);
    if (why !== "") return this.said.set(`not worked out: ${why}`);
    const { calibration } = this.model.view.value;
    // Another view drops the result, and the target may still be in sight.
    if (calibration?.is_on && calibration.is_automatic) void this.model.change({ is_automatic: false });
    await this.model.solve();
  }

  async save(): Promise<void> {
    const why = why_not_kept(this.model.view.value);
    if (why !== "") this.said.set(`not saved: ${why}`);
    else if (await this.model.save()) this.said.set("saved, and taken over");
  }

  async forget(id: string): Promise<void> {
    if (await this.model.forget(id)) this.said.set("view forgotten");
  }

  async forget_all(): Promise<void> {
    if (await this.model.forget_all()) this.said.set("all views forgotten");
  }

  private follow(): void {
    if (this.is_open && !document.hidden) {
      this.model.open();
      this.frames.open();
    } else {
      this.model.close();
      this.frames.close();
    }
  }
}
