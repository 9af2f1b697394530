import type { TeamPicture } from "../link/monitor_api";
import { Newest } from "../link/newest";
import { Observable } from "../link/observable";

/// What the page shows of the team: the newest when the screen is ready for it, or what was looked back at.
///
/// drawn   for the field: with every picture of the screen, if there is a newer one
/// read    for tables: less often, because numbers that change faster cannot be read
export class TeamFeed {
  readonly drawn = new Observable<TeamPicture | null>(null);
  readonly read = new Observable<TeamPicture | null>(null);
  private readonly waiting = new Newest<string>();
  private last_message: number | null = null;
  private last_read = -Infinity;
  messages = 0;
  /// Messages that were no team picture.
  broken = 0;

  constructor(private readonly read_interval_ms = 200) {}

  message(text: string, now: number): void {
    ++this.messages;
    this.last_message = now;
    this.waiting.put(text);
  }

  /// Since the last message, [ms]; nothing before the first.
  silence(now: number): number | null {
    return this.last_message === null ? null : now - this.last_message;
  }

  /// Once a picture of the screen. Of the messages, only the newest is parsed at all, and none while one looks back.
  tick(now: number, is_live: boolean): void {
    const text = is_live ? this.waiting.take() : null;
    if (text !== null) {
      try {
        this.drawn.set(JSON.parse(text) as TeamPicture);
      } catch {
        ++this.broken;
      }
    }
    if (now - this.last_read >= this.read_interval_ms && this.read.value !== this.drawn.value) {
      this.last_read = now;
      this.read.set(this.drawn.value);
    }
  }

  /// What was looked back at; tables need not wait long for it.
  show(picture: TeamPicture): void {
    this.drawn.set(picture);
  }
}
