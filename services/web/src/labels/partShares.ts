/** How much of a shape each part has. */
import type { SurfaceMesh } from "../geometry/surfaceMesh";

export interface PartShare {
  readonly nFaces: number;
  /** Of the whole surface, 0 to 1. */
  readonly area: number;
}

/** By part id, 0 for unlabelled; parts without a face are not among them. */
export function partShares(mesh: SurfaceMesh, labels: Uint16Array): Map<number, PartShare> {
  const nFaces = new Map<number, number>();
  const area = new Map<number, number>();
  let total = 0;
  labels.forEach((label, face) => {
    const size = mesh.crossLengths[face] as number;
    nFaces.set(label, (nFaces.get(label) ?? 0) + 1);
    area.set(label, (area.get(label) ?? 0) + size);
    total += size;
  });
  const share = (label: number) => (total > 0 ? (area.get(label) as number) / total : 0);
  return new Map([...nFaces].map(([label, count]) => [label, { nFaces: count, area: share(label) }]));
}
