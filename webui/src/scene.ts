// What a scene is, as schema/scene.schema.json says; what the pages do not show is left out.
// Robot frame: x forward, y left, meters and radians. Null: not known without calibration, or not seen.

export type Point = [number, number];
export type Color = "yellow" | "blue";
export type Team = "cyan" | "magenta" | "unknown";

export interface OnFloor {
  x: number | null;
  y: number | null;
  distance: number | null;
  bearing: number | null;
  near: number | null;
  far: number | null;
  cov: number[] | null;
}

export interface Ball extends OnFloor {
  box: number[];
  center: Point;
  radius_px: number;
  confidence: number;
}

export interface Robot extends OnFloor {
  team: Team;
  center: Point | null;
  width: number | null;
  box: number[];
}

export interface Goal {
  color: Color;
  box: number[];
  bearing: number | null;
  x: number | null;
  y: number | null;
  posts: { side: "left" | "right"; x: number; y: number }[];
}

export interface StraightLine {
  kind: "line" | "boundary";
  p: Point | null;
  q: Point | null;
  model: string | null;
}
export interface CircleLine {
  kind: "circle";
  center: Point;
  radius: number;
}

export interface FreeSpace {
  origin: Point;
  angle_min: number;
  angle_increment: number;
  ranges: (number | null)[];
  state: ("blocked" | "free" | "unseen")[];
}

/// What moves, and how well that is known.
export interface Moving {
  x: number;
  y: number;
  vx: number;
  vy: number;
  /// Row-major x, y, vx, vy.
  cov: number[];
  age: number;
}

export interface Track extends Moving {
  id: number;
  kind: "ball" | "robot";
  team: Team;
}

export interface Pose {
  x: number;
  y: number;
  theta: number;
  cov: number[];
  kind: string;
  age: number;
  mirror: boolean;
}

export interface Scene {
  frame: number;
  t: number;
  image?: string;
  pose: Pose | null;
  balls: Ball[];
  goals: Goal[];
  robots: Robot[];
  lines: (StraightLine | CircleLine)[];
  free_space: FreeSpace | null;
  tracks: Track[];
  why: Record<string, string>;
  timing_ms: Record<string, number>;
}
