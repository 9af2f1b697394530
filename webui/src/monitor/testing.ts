import type { TeamPicture, TeamRobot, TeamThing } from "../link/monitor_api";
import type { Pose } from "../scene";

// What several tests of the monitor need; no part of the page.

export function pose(x: number, y: number, theta = 0): Pose {
  return { x, y, theta, cov: [0.01, 0, 0, 0, 0.02, 0, 0, 0, 0.001], kind: "model", age: 0, mirror: false };
}

export function robot(id: number, of: Partial<TeamRobot> = {}, at: Pose | null = pose(0, 0)): TeamRobot {
  return {
    id, team: "cyan", presence: "here", age: 0.02, has_picture: true, scene: { pose: at, balls: [], goals: [], robots: [], lines: [], free_space: null, tracks: [] }, pose_kind: at === null ? "none" : at.kind,
    pose_age: at === null ? null : 0.1, role: "striker", action: "go_to_ball", planning_state: "planning", frame_rate: 29.97, latency: 0.021, message_age: 0.004, messages_per_second: 29.9,
    bytes_per_second: 41234, loss: 0.012, refused: 0, withheld: 0, clock_offset: 0.0007, troubles: [], ...of,
  };
}

/// Standing, known to 5 cm.
export function team_thing(x = 0, y = 0): TeamThing {
  return { x, y, vx: 0, vy: 0, cov: Array.from({ length: 16 }, (_, i) => (i % 5 === 0 ? 0.0025 : 0)), age: 0, robots: [1] };
}

export function team_picture(t: number, robots: TeamRobot[] = []): TeamPicture {
  return { t, robots, opponents: [], troubles: [], news: 0, counts: { heard: 0, refused: 0, late: 0, repeated: 0, bytes_per_second: 0 } };
}
