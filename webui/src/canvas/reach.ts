import type { Point, Scene } from "../scene";

/// How far the bird's-eye view looks, [m].
export const reaches = [2, 4, 6, 8, 12, 20] as const;

/// The distance of the furthest thing that the bird's-eye view shows, [m]; 0 when there is none.
export function furthest(scene: Scene): number {
  const points: (Point | null)[] = [];
  for (const thing of [...scene.balls, ...scene.robots, ...scene.goals, ...scene.tracks]) {
    if (thing.x !== null && thing.y !== null) points.push([thing.x, thing.y]);
  }
  for (const goal of scene.goals) for (const post of goal.posts) points.push([post.x, post.y]);
  const free = (scene.free_space?.ranges ?? []).map((range) => range ?? 0);
  return Math.max(0, ...points.map((p) => (p ? Math.hypot(...p) : 0)), ...free);
}

/// Grows at once and shrinks only when a smaller reach has been enough for a while: a view that jumps cannot be read.
export class AutomaticReach {
  private reach: number;
  private smaller_since: number | null = null;

  constructor(initial = 4, private readonly patience_ms = 3000) {
    this.reach = initial;
  }

  /// now  of any steady clock, [ms]
  next(needed: number, now: number): number {
    const fitting = reaches.find((reach) => reach >= needed) ?? reaches[reaches.length - 1]!;
    if (fitting > this.reach) {
      this.reach = fitting;
      this.smaller_since = null;
    } else if (fitting < this.reach) {
      this.smaller_since ??= now;
      if (now - this.smaller_since >= this.patience_ms) {
        this.reach = fitting;
        this.smaller_since = null;
      }
    } else {
      this.smaller_since = null;
    }
    return this.reach;
  }
}
