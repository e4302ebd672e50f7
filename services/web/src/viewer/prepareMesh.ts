/** Meshes made ready for viewing and painting, in a worker of their own. */
import { MeshBVH } from "three-mesh-bvh";
import type { SurfaceMesh } from "../geometry/surfaceMesh";
import { type Preparation, pickGeometry, prepared } from "./meshPreparation";

/** A mesh with all that viewing, picking and painting need of it. */
export interface PreparedMesh {
  readonly mesh: SurfaceMesh;
  /** Shading normals, four int16 to a corner. */
  readonly normals: Int16Array;
  readonly bvh: MeshBVH;
  /** Nobody looks at its inside: only the outside is drawn and picked. */
  readonly isSolid: boolean;
}

interface Answer {
  readonly request: number;
  readonly preparation: Preparation;
}

const waiting = new Map<
  number,
  { resolve: (preparation: Preparation) => void; reject: (error: Error) => void }
>();
let nRequests = 0;
let worker: Worker | undefined;

/** The mesh prepared; it keeps its measures and adjacency, too. Rejects when the worker cannot be started. */
export async function prepareMesh(mesh: SurfaceMesh): Promise<PreparedMesh> {
  const { vertices, faces } = mesh;
  const preparation =
    typeof Worker === "undefined" ? prepared(mesh) : await preparedElsewhere({ vertices, faces });
  mesh.adopt(preparation.measures, preparation.graph);
  const bvh = MeshBVH.deserialize(preparation.bvh, pickGeometry(vertices, faces), { setIndex: false });
  return { mesh, normals: preparation.normals, bvh, isSolid: preparation.isSolid };
}

function preparedElsewhere(arrays: { vertices: Float32Array; faces: Uint32Array }): Promise<Preparation> {
  worker ??= startedWorker();
  const request = nRequests++;
  worker.postMessage({ request, ...arrays });
  return new Promise((resolve, reject) => waiting.set(request, { resolve, reject }));
}

function startedWorker(): Worker {
  const started = new Worker(new URL("./meshPreparation.worker.ts", import.meta.url), { type: "module" });
  started.onmessage = ({ data }: MessageEvent<Answer>) => {
    waiting.get(data.request)?.resolve(data.preparation);
    waiting.delete(data.request);
  };
  started.onerror = (event) => {
    for (const { reject } of waiting.values())
      reject(new Error(`meshes cannot be prepared: ${event.message}`));
    waiting.clear();
    started.terminate();
    worker = undefined; // the next mesh tries anew
  };
  return started;
}
