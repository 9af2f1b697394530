import type { Scene } from "../scene";
import { Newest } from "./newest";
import { Observable } from "./observable";

/// So many scenes are kept to find a picture's own among them.
const recent_scenes = 20;

/// What the pages show of the scenes: the newest when the screen is ready for it, or none newer than when it was frozen.
///
/// drawn   for canvases: with every picture of the screen, if there is a newer one
/// read    for tables: less often, because numbers that change faster cannot be read; the same as `drawn` when frozen
export class Live {
  readonly drawn = new Observable<Scene | null>(null);
  readonly read = new Observable<Scene | null>(null);
  readonly timing = new Observable<readonly StageTime[]>([]);
  readonly frozen = new Observable(false);
  private readonly waiting = new Newest<string>();
  /// The last messages, newest last: a picture takes longer than its scene, and is to be frozen with it.
  private recent: string[] = [];
  private last_message: number | null = null;
  private last_read = -Infinity;
  private smoothing = new SmoothedTimes();
  /// Messages that were no scene.
  broken = 0;

  constructor(private readonly read_interval_ms = 150) {}

  get dropped(): number {
    return this.waiting.dropped;
  }

  message(text: string, now: number): void {
    this.last_message = now;
    this.waiting.put(text);
    if (this.frozen.value) return;
    this.recent.push(text);
    if (this.recent.length > recent_scenes) this.recent.shift();
  }

  /// Since the last scene came, [ms]; nothing before the first.
  silence(now: number): number | null {
    return this.last_message === null ? null : now - this.last_message;
  }

  /// Once a picture of the screen. Only the newest scene is parsed at all.
  tick(now: number): void {
    if (this.frozen.value) return;
    const text = this.waiting.take();
    if (text !== null) {
      try {
        const scene = JSON.parse(text) as Scene;
        this.smoothing.add(scene.timing_ms, now);
        this.drawn.set(scene);
      } catch {
        ++this.broken;
      }
    }
    if (now - this.last_read >= this.read_interval_ms) this.publish(now);
  }

  /// picture_frame  of the picture that is shown: its scene is frozen, if it is still known, else the one that is drawn
  freeze(picture_frame: number | null = null): void {
    const scene = this.recent_scene(picture_frame);
    if (scene !== null) this.drawn.set(scene);
    this.publish(this.last_read);
    this.frozen.set(true);
  }

  go_on(): void {
    this.frozen.set(false);
  }

  private recent_scene(frame: number | null): Scene | null {
    if (frame === null || frame === this.drawn.value?.frame) return null;
    for (let i = this.recent.length - 1; i >= 0; --i) {
      try {
        const scene = JSON.parse(this.recent[i]!) as Scene;
        if (scene.frame === frame) return scene;
      } catch {
        // counted when it came
      }
    }
    return null;
  }

  private publish(now: number): void {
    if (this.read.value === this.drawn.value) return;
    this.last_read = now;
    this.read.set(this.drawn.value);
    this.timing.set(this.smoothing.times());
  }
}

export interface StageTime {
  readonly stage: string;
  readonly ms: number;
}

/// Exponential means over about a second, whatever the rate; a stage that is gone from the scenes is gone from here.
export class SmoothedTimes {
  private means = new Map<string, number>();
  private last: number | null = null;

  constructor(private readonly time_constant_ms = 1000) {}

  add(timing: Readonly<Record<string, number>>, now: number): void {
    const share = this.last === null ? 1 : 1 - Math.exp(-Math.max(now - this.last, 0) / this.time_constant_ms);
    this.last = now;
    const next = new Map<string, number>();
    for (const [stage, ms] of Object.entries(timing)) {
      const mean = this.means.get(stage);
      next.set(stage, mean === undefined ? ms : mean + share * (ms - mean));
    }
    this.means = next;
  }

  /// In the scene's order.
  times(): StageTime[] {
    return [...this.means].map(([stage, ms]) => ({ stage, ms }));
  }
}
