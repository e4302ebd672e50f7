/** Reads one mesh from the service and prepares it, off the page's thread. */
import { readArrays } from "../api/arrays";
import { Problem } from "../api/problem";
import { arrayOf } from "../api/safetensors";
import { SurfaceMesh } from "../geometry/surfaceMesh";
import type { MeshMessage, MeshWish } from "./meshReader";
import { preparedSurface, transferables } from "./surfacePreparation";

const trees = import("./searchTree"); // it is much code, and what shows the surface needs none of it

self.onmessage = ({ data }: MessageEvent<MeshWish>) => {
  read(data).catch((error: unknown) => {
    const why = error instanceof Error ? error.message : String(error);
    tell({ kind: "failed", why, status: error instanceof Problem ? error.status : null });
  });
};

async function read({ meshHash, shapeId }: MeshWish): Promise<void> {
  const file = await readArrays(`/meshes/${meshHash}?shape_id=${shapeId}`);
  const vertices = arrayOf(file, "vertices", Float32Array);
  const mesh = new SurfaceMesh(vertices, arrayOf(file, "faces", Uint32Array), meshHash);
  const surface = preparedSurface(mesh);
  tell({ kind: "surface", surface }, transferables(surface));
  const { builtTree, buffersOf } = await trees;
  const tree = builtTree(mesh);
  tell({ kind: "tree", tree }, buffersOf(tree));
}

function tell(message: MeshMessage, transfer: ArrayBuffer[] = []): void {
  self.postMessage(message, { transfer });
}
