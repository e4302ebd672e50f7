/** Reads one mesh from the service and prepares it, off the page's thread. */
import { readArrays } from "../api/arrays";
import { Problem } from "../api/problem";
import { arrayOf } from "../api/safetensors";
import { SurfaceMesh } from "../geometry/surfaceMesh";
import type { MeshMessage, MeshWish } from "./meshReader";
import { preparedSurface, transferables } from "./surfacePreparation";

const code = import("./searchTree"); // it is much, and what shows the surface needs none of it
let mesh: SurfaceMesh;

self.onmessage = ({ data }: MessageEvent<MeshWish | "tree">) => {
  const task = data === "tree" ? tellTree() : tellSurface(data);
  task.catch((error: unknown) => {
    const why = error instanceof Error ? error.message : String(error);
    tell({ kind: "failed", why, status: error instanceof Problem ? error.status : null });
  });
};

async function tellSurface({ meshHash, shapeId }: MeshWish): Promise<void> {
  const file = await readArrays(`/meshes/${meshHash}?shape_id=${shapeId}`);
  const vertices = arrayOf(file, "vertices", Float32Array);
  mesh = new SurfaceMesh(vertices, arrayOf(file, "faces", Uint32Array), meshHash);
  const surface = preparedSurface(mesh);
  tell({ kind: "surface", surface }, transferables(surface));
}

async function tellTree(): Promise<void> {
  const { builtTree, buffersOf } = await code;
  const tree = builtTree(mesh);
  tell({ kind: "tree", tree }, buffersOf(tree));
}

function tell(message: MeshMessage, transfer: ArrayBuffer[] = []): void {
  self.postMessage(message, { transfer });
}
