import { Channel, type ChannelWorld } from "../link/channel";
import type { MonitorApi, TeamRobot } from "../link/monitor_api";
import { NewestDecoder } from "../link/newest";
import { Observable } from "../link/observable";
import { reason } from "../link/api";

/// What is to be seen of which robot, and when.
export interface Wanted {
  readonly id: number;
  /// As it is told; null when nobody tells of it.
  readonly robot: Pick<TeamRobot, "has_picture"> | null;
  /// Of the past: the time. Null: live.
  readonly t: number | null;
  readonly playing: boolean;
}

/// Without a picture so long, what is shown is old, [ms].
const patience_ms = 2000;
/// Pictures of the past are not asked for more often, while it is played, [ms].
const interval_ms = 100;

/// The annotated picture of the chosen robot: by its channel, which is open only while it is looked at, or of the past, by request.
export class RobotPictures {
  readonly picture = new Observable<ImageBitmap | null>(null);
  /// Why there is none, or that it is old; empty when all is well.
  readonly words = new Observable("");
  private channel: Channel | null = null;
  private id: number | null = null;
  private is_past = false;
  private asked_t: number | null = null;
  private asked_at = -Infinity;
  private last_picture: number | null = null;
  private trouble = "";
  private readonly from_channel: NewestDecoder<{ id: number; blob: Blob }, { id: number; bitmap: ImageBitmap }>;
  private readonly from_past: NewestDecoder<{ id: number; t: number }, void>;

  constructor(private readonly api: Pick<MonitorApi, "picture">, private readonly world: (path: string) => ChannelWorld,
              private readonly decode: (blob: Blob) => Promise<ImageBitmap> = (blob) => createImageBitmap(blob)) {
    this.from_channel = new NewestDecoder(
      async ({ id, blob }) => ({ id, bitmap: await this.decode(blob) }),
      ({ id, bitmap }) => this.show(id === this.id && !this.is_past ? bitmap : null, bitmap),
    );
    this.from_past = new NewestDecoder(({ id, t }) => this.ask(id, t), () => {});
  }

  /// Is its channel open, or to be opened again?
  get is_listening(): boolean {
    return this.channel !== null;
  }

  /// Often, and cheap while nothing changed. Null: nothing is to be seen.
  follow(wanted: Wanted | null, now: number): void {
    if (wanted === null || wanted.id !== this.id || (wanted.t !== null) !== this.is_past) this.forget();
    if (wanted === null) return;
    this.id = wanted.id;
    this.is_past = wanted.t !== null;
    if (wanted.t !== null) {
      if (wanted.t !== this.asked_t && (!wanted.playing || now - this.asked_at >= interval_ms)) {
        [this.asked_t, this.asked_at] = [wanted.t, now];
        this.from_past.put({ id: wanted.id, t: wanted.t });
      }
    } else if (wanted.robot?.has_picture === true) {
      this.channel ??= this.opened(wanted.id);
    } else {
      this.close();
    }
    this.words.set(this.words_of(wanted, now));
  }

  private words_of({ id, robot, t }: Wanted, now: number): string {
    if (t !== null) return this.trouble || (this.picture.value === null ? "asking for its picture" : "");
    if (robot === null) return `robot ${id} is not there`;
    if (!robot.has_picture) return `robot ${id} sends no pictures`;
    if (this.channel?.state.kind === "waiting") return "connection lost, trying again";
    if (this.picture.value === null || this.last_picture === null) return `waiting for a picture of robot ${id}`;
    const silence = now - this.last_picture;
    return silence > patience_ms ? `no picture for ${Math.round(silence / 1000)} s` : "";
  }

  private opened(id: number): Channel {
    const channel = new Channel(this.world(`/ws/picture${id}`), (data) => {
      if (data instanceof Blob) this.from_channel.put({ id, blob: data });
    }, () => {});
    channel.start();
    return channel;
  }

  private async ask(id: number, t: number): Promise<void> {
    let bitmap: ImageBitmap | null = null;
    let trouble = "no picture of this time";
    try {
      const blob = await this.api.picture(id, t);
      if (blob !== null) bitmap = await this.decode(blob);
    } catch (error) {
      trouble = reason(error);
    }
    if (id !== this.id || !this.is_past) return bitmap?.close();
    this.trouble = bitmap === null ? trouble : "";
    this.show(bitmap, bitmap);
  }

  /// made  is let go when it is not the one that is shown
  private show(bitmap: ImageBitmap | null, made: ImageBitmap | null): void {
    if (bitmap === null && made !== null) return made.close();
    const before = this.picture.value;
    this.last_picture = performance.now();
    this.picture.set(bitmap);
    before?.close();
  }

  private forget(): void {
    this.close();
    this.id = null;
    [this.asked_t, this.asked_at, this.last_picture, this.trouble] = [null, -Infinity, null, ""];
    const before = this.picture.value;
    this.picture.set(null);
    before?.close();
    this.words.set("");
  }

  private close(): void {
    this.channel?.stop();
    this.channel = null;
  }
}
