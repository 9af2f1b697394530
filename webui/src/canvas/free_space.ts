import type { FreeSpace, Point } from "../scene";

/// Neighboring sectors that are seen, as one polygon: origin first, then two corners a sector by rising angle. A corner is on
/// the sector's own range, so that the polygon never claims more than the scene does.
export function free_polygons(space: FreeSpace): Point[][] {
  const polygons: Point[][] = [];
  let polygon: Point[] | null = null;
  for (let i = 0; i < space.ranges.length; ++i) {
    const range = space.ranges[i];
    if (range == null || space.state[i] === "unseen") {
      polygon = null;
      continue;
    }
    if (polygon === null) {
      polygon = [space.origin];
      polygons.push(polygon);
    }
    polygon.push(corner(space, i - 0.5, range), corner(space, i + 0.5, range));
  }
  return polygons;
}

/// The far edges of the sectors that an obstacle ends.
export function blocked_edges(space: FreeSpace): [Point, Point][] {
  const edges: [Point, Point][] = [];
  for (let i = 0; i < space.ranges.length; ++i) {
    const range = space.ranges[i];
    if (range != null && space.state[i] === "blocked") edges.push([corner(space, i - 0.5, range), corner(space, i + 0.5, range)]);
  }
  return edges;
}

function corner(space: FreeSpace, sector: number, range: number): Point {
  const angle = space.angle_min + sector * space.angle_increment;
  return [space.origin[0] + range * Math.cos(angle), space.origin[1] + range * Math.sin(angle)];
}
