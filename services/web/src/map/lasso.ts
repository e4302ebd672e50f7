/** Which points lie inside a line that was drawn around them. */
import type { Box } from "./camera";
import type { MapPoints } from "./mapPoints";
import type { PointGrid } from "./pointGrid";

export type Place = readonly [x: number, y: number];

/** Whether a place is inside, by how often a line from it to the right crosses the outline (even-odd rule). */
export function isInside(outline: readonly Place[], x: number, y: number): boolean {
  let inside = false;
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    const [xi, yi] = outline[i] as Place;
    const [xj, yj] = outline[j] as Place;
    if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) inside = !inside;
  }
  return inside;
}

/** Places of the points inside an outline on the map, in ascending order. */
export function pointsInside(points: MapPoints, grid: PointGrid, outline: readonly Place[]): number[] {
  if (outline.length < 3) return [];
  const xs = outline.map(([x]) => x);
  const ys = outline.map(([, y]) => y);
  const box: Box = {
    left: Math.min(...xs),
    right: Math.max(...xs),
    bottom: Math.min(...ys),
    top: Math.max(...ys),
  };
  return grid.within(box).filter((i) => isInside(outline, points.x[i] as number, points.y[i] as number));
}
