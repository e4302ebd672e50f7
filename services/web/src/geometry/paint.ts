/**
 * The faces a brush takes, face for face as `partwise.segmentation.paint`: see docs/segmentation.md.
 *
 * `tests/golden/paint` holds meshes, strokes and the faces they take.
 */
import type { SurfaceMesh } from "./surfaceMesh";

export interface Brush {
  /** In (0, 1], Euclidean between centroids, as a share of the bounding box's diagonal. */
  readonly radius: number;
  /** In [−1, 1], least cosine of the angle to the clicked face's normal; null for no limit. */
  readonly min_cosine: number | null;
}

/** The cosine of an angle limit in degrees. Made once, when the limit is chosen: strokes keep the cosine. */
export function cosineOfLimit(degrees: number): number {
  return Math.cos((degrees * Math.PI) / 180);
}

/** Faces that one click takes, ascending. `isOpen` says which faces may be taken or crossed; all when left out. */
export function clickedFaces(
  mesh: SurfaceMesh,
  seed: number,
  brush: Brush,
  isOpen?: (face: number) => boolean,
): Uint32Array {
  const { graph, centroids, crosses, crossLengths, diagonal } = mesh;
  graph.checkFace(seed);
  const reach = brush.radius * diagonal;
  const squaredReach = reach * reach;
  const minCosine = brush.min_cosine;
  const at = 3 * seed;
  const [sx, sy, sz] = [centroids[at] as number, centroids[at + 1] as number, centroids[at + 2] as number];
  const [nx, ny, nz] = [crosses[at] as number, crosses[at + 1] as number, crosses[at + 2] as number];
  const length = crossLengths[seed] as number;

  return graph.grown(seed, (face) => {
    const k = 3 * face;
    const dx = (centroids[k] as number) - sx;
    const dy = (centroids[k + 1] as number) - sy;
    const dz = (centroids[k + 2] as number) - sz;
    if (dx * dx + dy * dy + dz * dz > squaredReach) return false;
    if (minCosine !== null && face !== seed) {
      const product =
        (crosses[k] as number) * nx + (crosses[k + 1] as number) * ny + (crosses[k + 2] as number) * nz;
      if (product < minCosine * (length * (crossLengths[face] as number))) return false;
    }
    return isOpen === undefined || isOpen(face);
  });
}

/** Faces that a drag over `seeds` takes, ascending: the union of what a click on each takes. */
export function paintedFaces(
  mesh: SurfaceMesh,
  seeds: readonly number[],
  brush: Brush,
  isOpen?: (face: number) => boolean,
): Uint32Array {
  const drag = new Drag(mesh, brush, isOpen);
  for (const seed of seeds) drag.click(seed);
  return drag.faces();
}

/** A drag while it goes on: what each further click adds, judged on the labels before the drag. */
export class Drag {
  readonly seeds: number[] = [];
  readonly #mesh: SurfaceMesh;
  readonly #brush: Brush;
  readonly #isOpen: ((face: number) => boolean) | undefined;
  readonly #taken: Uint8Array;
  #nTaken = 0;

  constructor(mesh: SurfaceMesh, brush: Brush, isOpen?: (face: number) => boolean) {
    this.#mesh = mesh;
    this.#brush = brush;
    this.#isOpen = isOpen;
    this.#taken = new Uint8Array(mesh.nFaces);
  }

  /** Faces that this click adds to the drag, ascending; none where the same face was clicked before. */
  click(seed: number): Uint32Array {
    if (this.seeds.includes(seed)) return new Uint32Array(0);
    const added = clickedFaces(this.#mesh, seed, this.#brush, this.#isOpen).filter(
      (face) => !this.#taken[face],
    );
    for (const face of added) this.#taken[face] = 1;
    this.#nTaken += added.length;
    this.seeds.push(seed);
    return added;
  }

  /** All faces taken so far, ascending. */
  faces(): Uint32Array {
    const faces = new Uint32Array(this.#nTaken);
    let n = 0;
    this.#taken.forEach((isTaken, face) => {
      if (isTaken) faces[n++] = face;
    });
    return faces;
  }
}
