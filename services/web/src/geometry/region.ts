/** Segment-wide: the connected region of equal label around a face. */
import type { FaceGraph } from "./faceGraph";

/** Faces joined to `seed` through faces of its label, ascending; unlabelled is a label like any other here. */
export function regionOf(graph: FaceGraph, labels: Uint16Array | Uint32Array, seed: number): Uint32Array {
  graph.checkFace(seed);
  const label = labels[seed];
  return graph.grown(seed, (face) => labels[face] === label);
}
