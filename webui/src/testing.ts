import type { Scene } from "./scene";

// What several tests need; no part of the pages.

/// The same numbers for the same seed, evenly spread. source: "mulberry32", Tommy Ettinger, public domain.
export function numbers_from(seed: number, low: number, high: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return low + ((high - low) * ((t ^ (t >>> 14)) >>> 0)) / 2 ** 32;
  };
}

export function empty_scene(frame = 0): Scene {
  return { frame, t: frame / 20, pose: null, balls: [], goals: [], robots: [], lines: [], free_space: null, tracks: [], why: {}, timing_ms: { total: 1 } };
}
