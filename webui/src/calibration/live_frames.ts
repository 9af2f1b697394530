import { browser_world, Channel } from "../link/channel";
import { parse_frame, type YuvFrame } from "../link/frame_bytes";
import { Observable } from "../link/observable";
import { rate_between } from "./fit";

/// The newest frame, while somebody looks.
export class LiveFrames {
  readonly newest = new Observable<YuvFrame | null>(null);
  /// Of the camera, as its frames tell. [Hz]
  rate_hz = 30;
  private is_open = false;
  private readonly channel = new Channel(browser_world("/ws/frame"), (data) => this.message(data), () => {}, "arraybuffer");

  constructor(private readonly frozen: Observable<boolean>) {
    frozen.subscribe(() => this.listen());
  }

  open(): void {
    this.is_open = true;
    this.listen();
  }

  close(): void {
    this.is_open = false;
    this.listen();
  }

  retry(): void {
    this.channel.retry();
  }

  /// Frames are large: they come only while they are looked at.
  private listen(): void {
    const stands = this.frozen.value && this.newest.value !== null;
    if (this.is_open && !stands) this.channel.start();
    else this.channel.stop();
  }

  private message(data: unknown): void {
    if (this.frozen.value && this.newest.value !== null) return;
    let frame: YuvFrame;
    try {
      if (!(data instanceof ArrayBuffer)) return;
      frame = parse_frame(data);
    } catch {
      return;   // the next one may be one
    }
    if (this.newest.value !== null) this.rate_hz = rate_between(this.newest.value, frame) ?? this.rate_hz;
    this.newest.set(frame);
    if (this.frozen.value) this.listen();
  }
}
