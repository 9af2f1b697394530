import { CalibrationSession } from "./calibration/calibration_session";
import { ColorsSession } from "./colors/colors_session";
import { Channel, browser_world } from "./link/channel";
import { type Api, server_api, type ServerState } from "./link/api";
import { type Condition, condition_of } from "./link/condition";
import { frame_of_jpeg } from "./link/jpeg";
import { Live } from "./link/live";
import { again_and_again, on_every_frame } from "./link/loops";
import { NewestDecoder } from "./link/newest";
import { Observable } from "./link/observable";
import { RecordingModel } from "./live/recording_model";
import { StagesModel } from "./stages/model";

/// A picture, and the frame it shows where the server says so.
export interface Picture {
  readonly bitmap: ImageBitmap;
  readonly frame: number | null;
}

/// Comments stand at a JPEG's beginning, [B].
const jpeg_head = 1024;

async function decode(blob: Blob): Promise<Picture> {
  const [bitmap, head] = await Promise.all([createImageBitmap(blob), blob.slice(0, jpeg_head).arrayBuffer()]);
  return { bitmap, frame: frame_of_jpeg(new Uint8Array(head)) };
}

/// Everything between this page and the server, for as long as the page is open.
export class Session {
  readonly live = new Live();
  readonly picture = new Observable<Picture | null>(null);
  readonly server = new Observable<ServerState | null>(null);
  readonly condition = new Observable<Condition>({ tone: "warning", text: "connecting" });
  readonly stages: StagesModel;
  readonly colors = new ColorsSession(this.live.frozen);
  readonly calibration = new CalibrationSession(this.live.frozen);
  readonly recording = new RecordingModel();
  private trouble = "";
  private pictures_wanted = true;
  private decoded: Picture | null = null;
  private readonly decoder = new NewestDecoder<Blob, Picture>(decode, (picture) => {
    this.decoded?.bitmap.close();
    this.decoded = picture;
  });
  private readonly scene_channel: Channel;
  private readonly picture_channel: Channel;

  constructor(private readonly api: Api = server_api) {
    this.stages = new StagesModel(api);
    this.scene_channel = new Channel(browser_world("/ws/scene"), (data) => this.live.message(String(data), performance.now()), () => this.judge());
    this.picture_channel = new Channel(browser_world("/ws/picture"), (data) => {
      if (data instanceof Blob) this.decoder.put(data);
    }, () => {});
  }

  start(): void {
    this.scene_channel.start();
    this.picture_channel.start();
    void this.stages.refresh();
    on_every_frame((now) => {
      this.live.tick(now);
      this.show_picture();
    });
    again_and_again(() => this.ask_state(), 1000);
    setInterval(() => this.judge(), 250);
    addEventListener("online", () => this.retry());
    // Nobody looks: the radio link has better things to carry, and the server need not draw.
    document.addEventListener("visibilitychange", () => this.listen_to_pictures());
  }

  /// Pages without the annotated picture say so.
  want_pictures(wanted: boolean): void {
    this.pictures_wanted = wanted;
    this.listen_to_pictures();
  }

  private listen_to_pictures(): void {
    if (document.hidden || !this.pictures_wanted) this.picture_channel.stop();
    else this.picture_channel.start();
  }

  retry(): void {
    this.scene_channel.retry();
    this.picture_channel.retry();
    this.colors.pictures.retry();
    this.calibration.retry();
  }

  toggle_freeze(): void {
    if (this.live.frozen.value) this.live.go_on();
    else this.live.freeze(this.picture.value?.frame ?? null);
    this.judge();
  }

  /// Pictures that this page was too slow for, and scenes.
  get skipped(): number {
    return this.decoder.dropped + this.live.dropped;
  }

  private show_picture(): void {
    if (this.live.frozen.value || this.decoded === null) return;
    const before = this.picture.value;
    this.picture.set(this.decoded);
    this.decoded = null;
    before?.bitmap.close();
  }

  private async ask_state(): Promise<void> {
    try {
      const state = await this.api.state();
      const before = this.server.value;
      this.trouble = "";
      this.server.set(state);
      this.recording.told(state.recording ?? null);
      // Somebody else, or the robot file, may have changed the stages; a server that was started anew has its own.
      if (before !== null && (before.configuration.taken_over !== state.configuration.taken_over || state.frames < before.frames)) {
        void this.stages.refresh();
      } else if (this.stages.view.value.stages === null) {
        void this.stages.refresh();
      }
    } catch (error) {
      this.trouble = error instanceof Error ? error.message : String(error);
    }
    this.judge();
  }

  private judge(): void {
    const now = performance.now();
    const condition = condition_of({
      scene: this.scene_channel.state,
      frozen: this.live.frozen.value,
      ended: this.server.value?.ended ?? false,
      trouble: this.trouble,
      silence_ms: this.live.silence(now),
      now,
    });
    const shown = this.condition.value;
    if (shown.text !== condition.text || shown.tone !== condition.tone) this.condition.set(condition);
  }
}
