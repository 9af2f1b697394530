import type { Point } from "../scene";
import { type ImageSize, is_empty, rectangle_between, type Shape, simplified, to_quarter, within } from "./shapes";

export const tools = ["polygon", "rectangle", "brush", "select"] as const;
export type Tool = (typeof tools)[number];
export type DrawingTool = Exclude<Tool, "select">;

/// A shape on its way. Immutable.
export type Begun =
  | { readonly tool: "polygon"; readonly corners: readonly Point[] }
  | { readonly tool: "rectangle"; readonly from: Point; readonly to: Point }
  | { readonly tool: "brush"; readonly way: readonly Point[]; readonly radius: number };

/// So near to the first corner a polygon is closed, and so near to the last a corner is a second click at the same place. [px of the page]
export const corner_reach = 9;

/// shape  null: nothing is finished
export interface Step {
  readonly begun: Begun | null;
  readonly shape: Shape | null;
}

function finished(shape: Shape): Step {
  return { begun: null, shape: is_empty(shape) ? null : shape };
}

/// A corner that was clicked. reach in pixels of the image.
export function add_corner(begun: Begun | null, at: Point, reach: number, size: ImageSize): Step {
  const corners = begun?.tool === "polygon" ? begun.corners : [];
  const corner = to_quarter(within(at, size));
  const near = (other: Point | undefined): boolean => other !== undefined && Math.hypot(other[0] - corner[0], other[1] - corner[1]) <= reach;
  if (corners.length >= 3 && (near(corners[0]) || near(corners.at(-1)))) return finished({ polygon: corners });
  // The same place again, as a double click does.
  if (corners.length > 0 && near(corners.at(-1))) return { begun, shape: null };
  return { begun: { tool: "polygon", corners: [...corners, corner] }, shape: null };
}

/// The pointer went down, for tools that are dragged.
export function begin(tool: "rectangle" | "brush", at: Point, radius: number, size: ImageSize): Begun {
  const point = within(at, size);
  return tool === "rectangle" ? { tool, from: point, to: point } : { tool, way: [point], radius };
}

export function drag(begun: Begun, at: Point, size: ImageSize): Begun {
  const point = within(at, size);
  if (begun.tool === "rectangle") return { ...begun, to: point };
  if (begun.tool !== "brush") return begun;
  const last = begun.way.at(-1)!;
  return Math.hypot(point[0] - last[0], point[1] - last[1]) < 0.25 ? begun : { ...begun, way: [...begun.way, point] };
}

/// The pointer went up, or Enter was pressed.
export function finish(begun: Begun, size: ImageSize): Step {
  switch (begun.tool) {
    case "polygon": return begun.corners.length < 3 ? { begun, shape: null } : finished({ polygon: begun.corners });
    case "rectangle": return finished(rectangle_between(begun.from, begun.to, size));
    case "brush": return finished({ stroke: simplified(begun.way, 0.25).map(to_quarter), radius: begun.radius });
  }
}

/// Without its last corner.
export function without_corner(begun: Begun | null): Begun | null {
  if (begun?.tool !== "polygon") return begun;
  return begun.corners.length <= 1 ? null : { ...begun, corners: begun.corners.slice(0, -1) };
}

export const least_radius = 0.5;
export const largest_radius = 60;

/// The next smaller or larger brush; steps grow with it. [px]
export function next_radius(radius: number, direction: 1 | -1): number {
  const step = direction > 0 ? (radius < 4 ? 0.5 : radius < 12 ? 1 : radius < 30 ? 3 : 6) : radius <= 4 ? 0.5 : radius <= 12 ? 1 : radius <= 30 ? 3 : 6;
  return Math.min(Math.max(radius + direction * step, least_radius), largest_radius);
}
