/** Meshes made ready for viewing and painting, off the page's thread. */
import { MeshBVH } from "three-mesh-bvh";
import type { SurfaceMesh } from "../geometry/surfaceMesh";
import { type MeshArrays, type Preparation, pickGeometry, prepared } from "./meshPreparation";

/** A mesh with all that viewing, picking and painting need of it. */
export interface PreparedMesh {
  readonly mesh: SurfaceMesh;
  /** Shading normals, four int16 to a corner. */
  readonly normals: Int16Array;
  readonly bvh: MeshBVH;
  /** Nobody looks at its inside: only the outside is drawn and picked. */
  readonly isSolid: boolean;
}

/** The mesh prepared; it keeps its measures and adjacency, too. Rejects where the worker fails. */
export async function prepareMesh(mesh: SurfaceMesh): Promise<PreparedMesh> {
  const { vertices, faces } = mesh;
  const preparation =
    typeof Worker === "undefined" ? prepared(mesh) : await preparedElsewhere({ vertices, faces });
  mesh.adopt(preparation.measures, preparation.graph);
  const bvh = MeshBVH.deserialize(preparation.bvh, pickGeometry(vertices, faces), { setIndex: false });
  return { mesh, normals: preparation.normals, bvh, isSolid: preparation.isSolid };
}

/** A worker for each mesh: the next one is prepared while this one is, and nothing is left of it afterwards. */
async function preparedElsewhere(arrays: MeshArrays): Promise<Preparation> {
  const worker = new Worker(new URL("./meshPreparation.worker.ts", import.meta.url), { type: "module" });
  try {
    return await new Promise((resolve, reject) => {
      worker.onmessage = ({ data }: MessageEvent<Preparation>) => resolve(data);
      worker.onerror = ({ message }) =>
        reject(new Error(`the shape cannot be prepared for viewing: ${message}`));
      worker.postMessage(arrays);
    });
  } finally {
    worker.terminate();
  }
}
