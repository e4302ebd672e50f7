/** The map of a collection in columns: where every embedded shape lies, its cluster, and where it stands. */
import type { Schemas } from "../api/client";

type Page = Schemas["EmbeddingPage"];
export type PointState = Page["states"][number];

export const POINT_STATES: readonly PointState[] = ["new", "failed", "ready", "review", "confirmed"];
/** In place of a cluster where none is on record. */
export const NO_CLUSTER = -1;

/** `n` points; ids ascend. x, y : in units of the embedding. cluster : NO_CLUSTER or from 0 on. state : in POINT_STATES. */
export interface MapPoints {
  readonly n: number;
  readonly ids: Float64Array;
  readonly x: Float32Array;
  readonly y: Float32Array;
  readonly cluster: Int32Array;
  readonly state: Uint8Array;
  readonly isFirst: Uint8Array;
}

export function pointsOf(pages: readonly Page[]): MapPoints {
  const n = pages.reduce((sum, page) => sum + page.shape_ids.length, 0);
  const points = {
    n,
    ids: new Float64Array(n),
    x: new Float32Array(n),
    y: new Float32Array(n),
    cluster: new Int32Array(n).fill(NO_CLUSTER),
    state: new Uint8Array(n),
    isFirst: new Uint8Array(n),
  };
  let start = 0;
  for (const page of pages) {
    const first = new Set(page.first_shape_ids);
    points.ids.set(page.shape_ids, start);
    points.x.set(page.x, start);
    points.y.set(page.y, start);
    page.shape_ids.forEach((id, i) => {
      points.cluster[start + i] = page.clusters[i] ?? NO_CLUSTER;
      points.state[start + i] = Math.max(0, POINT_STATES.indexOf(page.states[i] ?? "new"));
      points.isFirst[start + i] = first.has(id) ? 1 : 0;
    });
    start += page.shape_ids.length;
  }
  return points;
}

/** Place of a shape among the points; -1 if it is not on the map. */
export function placeOf(points: MapPoints, shapeId: number): number {
  let low = 0;
  let high = points.n - 1;
  while (low <= high) {
    const middle = (low + high) >> 1;
    const id = points.ids[middle] ?? 0;
    if (id === shapeId) return middle;
    if (id < shapeId) low = middle + 1;
    else high = middle - 1;
  }
  return -1;
}

/** How many shapes each cluster has, by cluster; without those that have none. */
export function clusterSizes(points: MapPoints): Map<number, number> {
  const sizes = new Map<number, number>();
  for (const cluster of points.cluster) {
    if (cluster !== NO_CLUSTER) sizes.set(cluster, (sizes.get(cluster) ?? 0) + 1);
  }
  return new Map([...sizes].sort(([a], [b]) => a - b));
}

/** The same points with other states of some shapes, by id; the very same object where that changes nothing. */
export function withStates(points: MapPoints, states: ReadonlyMap<number, PointState>): MapPoints {
  const state = points.state.slice();
  let isChanged = false;
  for (const [id, name] of states) {
    const place = placeOf(points, id);
    const number = POINT_STATES.indexOf(name);
    if (place < 0 || number < 0 || state[place] === number) continue;
    state[place] = number;
    isChanged = true;
  }
  return isChanged ? { ...points, state } : points;
}
