/** Maps for tests. */
import { type MapPoints, NO_CLUSTER } from "./mapPoints";

export function somePoints(x: readonly number[], y: readonly number[]): MapPoints {
  const n = x.length;
  return {
    n,
    ids: Float64Array.from({ length: n }, (_, i) => i + 1),
    x: Float32Array.from(x),
    y: Float32Array.from(y),
    cluster: new Int32Array(n).fill(NO_CLUSTER),
    state: new Uint8Array(n),
    isFirst: new Uint8Array(n),
  };
}
