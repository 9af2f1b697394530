import type { Canvas2D } from "./pen";

/// For tests: a context that notes down what it is told.
export function recorder(): { context: Canvas2D; calls: [string, ...unknown[]][] } {
  const calls: [string, ...unknown[]][] = [];
  const context = new Proxy({}, {
    get: (_, name: string) => (...values: unknown[]) => {
      calls.push([name, ...values]);
      return name === "measureText" ? { width: 30 } : undefined;
    },
    set: (_, name: string, value) => {
      calls.push([name, value]);
      return true;
    },
  });
  return { context: context as Canvas2D, calls };
}
