import type { TeamPicture, Trail, TrailPoint } from "../link/monitor_api";

/// How far back trails go, [s].
export const trail_seconds = 5;
/// Points are no closer, [s].
const spacing = 0.1;
/// Whoever was not heard so long, or was elsewhere at once, did not drive there straight, [s, m].
const longest_gap = 0.6;
const longest_jump = 0.8;

/// Where the robots were of late.
export class Trails {
  private of_robot = new Map<number, TrailPoint[]>();

  /// The newest place of each robot that has one. When the time went back, what came after it is forgotten.
  add(picture: TeamPicture): void {
    for (const { id, age, scene: { pose } } of picture.robots) {
      const points = this.of_robot.get(id) ?? [];
      this.of_robot.set(id, points);
      while (points.length > 0 && points[points.length - 1]![0] > picture.t) points.pop();
      while (points.length > 0 && points[0]![0] < picture.t - trail_seconds) points.shift();
      if (pose === null || age > spacing) continue;
      const last = points[points.length - 1];
      if (last === undefined || picture.t - last[0] >= spacing) points.push([picture.t, pose.x, pose.y]);
    }
  }

  /// What the server remembers; what is known from after that stays.
  take(trails: readonly Trail[], until: number): void {
    const before = this.of_robot;
    this.of_robot = new Map(trails.map(({ id, points }) => [id, [...points, ...(before.get(id) ?? []).filter(([t]) => t > until)]]));
  }

  clear(): void {
    this.of_robot.clear();
  }

  /// Ways driven in the seconds before a time, without the gaps between them.
  ways(id: number, t: number): (readonly [number, number])[][] {
    const ways: (readonly [number, number])[][] = [];
    let before: TrailPoint | null = null;
    for (const point of this.of_robot.get(id) ?? []) {
      if (point[0] < t - trail_seconds || point[0] > t) continue;
      const is_new = before === null || point[0] - before[0] > longest_gap || Math.hypot(point[1] - before[1], point[2] - before[2]) > longest_jump;
      if (is_new) ways.push([]);
      ways[ways.length - 1]!.push([point[1], point[2]]);
      before = point;
    }
    return ways;
  }
}
