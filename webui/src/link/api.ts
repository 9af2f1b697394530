// The requests that the server answers; public/openapi.yaml documents them.

import type { Recording } from "../live/recording_model";

export interface FieldPlan {
  length: number;
  width: number;
  circle_radius?: number;
  halfway_line?: boolean;
  areas?: { depth: number; width: number }[];
  goals?: { side: "+x" | "-x"; color: string; width: number; depth: number }[];
  /// Servers may leave these out.
  segments?: [number, number, number, number][];
  arcs?: [number, number, number, number, number][];
  walls?: { x: [number, number]; y: [number, number] } | null;
  ball?: { radius: [number, number] };
  robots?: { width: [number, number] };
}

export interface ServerState {
  version: string;
  robot: string;
  source: { name: string; description: string };
  frame: number;
  t: number;
  rate_hz: number;
  frames: number;
  dropped: number;
  configuration: { taken_over: number; refusal: string };
  web: { viewers: number; clients: number; sent: number; dropped: number };
  ended: boolean;
  /// Servers may leave these out.
  latency_ms?: number | null;
  mount_drift?: string;
  picture_fault?: string;
  recording?: Recording;
  field?: FieldPlan | null;
}

export interface Option {
  key: string;
  unit: string;
  low: number;
  high: number;
  whole: boolean;
  meaning: string;
  default: number;
  value: number;
  changed: boolean;
}

export interface Alternative {
  name: string;
  meaning: string;
  default: boolean;
  chosen: boolean;
  options: Option[];
}

export interface Stage {
  key: string;
  meaning: string;
  alternatives: Alternative[];
  options: Option[];
  /// Is the chosen alternative another than the robot file's? Servers may leave it out.
  changed?: boolean;
}

/// What is asked for: a name, a number, or null for the robot file's value.
export type Change = Record<string, string | number | null>;

/// The server refused a request and said why.
export class Refused extends Error {
  constructor(readonly status: number, reason: string) {
    super(reason);
  }
}

export interface Api {
  state(): Promise<ServerState>;
  stages(): Promise<Stage[]>;
  change(change: Change): Promise<Stage[]>;
}

export const patience_ms = 5000;

export async function ask<T>(path: string, init: RequestInit = {}): Promise<T> {
  const response = await fetch(path, { ...init, cache: "no-store", signal: AbortSignal.timeout(patience_ms) });
  if (response.ok) return (await response.json()) as T;
  if (response.status === 401) throw new Refused(401, "not admitted: open the address that the server printed at its start");
  throw new Refused(response.status, (await response.text()).trim() || `the server answers ${response.status}`);
}

export function with_json(method: string, body: unknown): RequestInit {
  return { method, headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
}

export const server_api: Api = {
  state: () => ask("/api/state"),
  stages: () => ask("/api/stages"),
  change: (change) => ask("/api/stages", with_json("PUT", change)),
};

/// Why a request failed, in words.
export function reason(error: unknown): string {
  if (error instanceof DOMException && error.name === "TimeoutError") return "the server does not answer";
  if (error instanceof TypeError) return "the server cannot be reached";
  return error instanceof Error ? error.message : String(error);
}
