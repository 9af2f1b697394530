import type { Goal, Moving, OnFloor, Robot, Scene, Team } from "../scene";
import { ask, type FieldPlan, patience_ms, Refused } from "./api";

// The requests that `tassilo monitor` answers; public/monitor_openapi.yaml documents them.

export interface MonitorState {
  version: string;
  mode: "live" | "log";
  name?: string;
  /// Why a log ends early; empty when it is whole.
  damage?: string;
  field: FieldPlan | null;
  /// What can be looked back at; null while there is nothing.
  begin: number | null;
  end: number | null;
  /// Between two team pictures that can be looked back at, [s]. Servers may leave it out.
  step?: number;
}

/// A scene without what is of its image.
export interface SeenScene extends Pick<Scene, "pose" | "free_space" | "tracks" | "lines"> {
  balls: OnFloor[];
  goals: Omit<Goal, "box">[];
  robots: Omit<Robot, "box">[];
}

export type Presence = "here" | "stale" | "gone";

export interface TeamRobot {
  id: number;
  team: Team;
  presence: Presence;
  age: number;
  has_picture: boolean;
  scene: SeenScene;
  pose_kind: string;
  pose_age: number | null;
  role: string;
  action: string;
  planning_state: string;
  frame_rate: number;
  latency: number;
  message_age: number | null;
  messages_per_second: number;
  bytes_per_second: number;
  loss: number | null;
  refused: number;
  withheld: number;
  clock_offset: number | null;
  troubles: string[];
}

/// What the robots know together, in the field frame at the picture's time.
export interface TeamThing extends Moving {
  /// Who saw it of late.
  robots: number[];
}
export interface TeamOpponent extends TeamThing {
  id: number;
  team: Team;
}

export interface TeamPicture {
  t: number;
  robots: TeamRobot[];
  /// Missing while nobody knows where it is.
  team_ball?: TeamThing;
  opponents: TeamOpponent[];
  troubles: string[];
  news: number;
  counts: { heard: number; refused: number; late: number; repeated: number; bytes_per_second: number };
}

/// t, x, y in the field frame. [s, m, m]
export type TrailPoint = [number, number, number];
export interface Trail {
  id: number;
  points: TrailPoint[];
}

export interface NewsItem {
  number: number;
  t: number;
  robot: number | null;
  text: string;
}

export interface MonitorApi {
  state(): Promise<MonitorState>;
  at(t: number): Promise<TeamPicture>;
  trails(t: number, seconds: number): Promise<Trail[]>;
  news(after: number): Promise<NewsItem[]>;
  /// Null: there is none of this time.
  picture(robot: number, t: number): Promise<Blob | null>;
}

export const monitor_api: MonitorApi = {
  state: () => ask("/api/monitor"),
  at: (t) => ask(`/api/monitor/at?t=${t}`),
  trails: async (t, seconds) => (await ask<{ robots: Trail[] }>(`/api/monitor/trails?t=${t}&seconds=${seconds}`)).robots,
  news: (after) => ask(`/api/monitor/news?after=${after}`),
  picture: async (robot, t) => {
    const response = await fetch(`/api/monitor/picture?robot=${robot}&t=${t}`, { cache: "no-store", signal: AbortSignal.timeout(patience_ms) });
    if (response.status === 404) return null;
    if (!response.ok) throw new Refused(response.status, (await response.text()).trim() || `the server answers ${response.status}`);
    return response.blob();
  },
};
