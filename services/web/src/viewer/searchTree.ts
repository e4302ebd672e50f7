/** The tree in which a mesh's faces are found along a ray: built in a worker, used by the page. */
import { BufferAttribute, BufferGeometry } from "three";
import { MeshBVH, type SerializedBVH } from "three-mesh-bvh";
import type { MeshArrays } from "./surfacePreparation";

export type { MeshBVH, SerializedBVH };

/** Faces keep the mesh's order. */
export function builtTree(mesh: MeshArrays): SerializedBVH {
  const tree = new MeshBVH(geometryOf(mesh), { indirect: true });
  return { ...MeshBVH.serialize(tree, { cloneBuffers: false }), index: null };
}

/** The buffers that can be handed over instead of copied. */
export function buffersOf({ roots, indirectBuffer }: SerializedBVH): ArrayBuffer[] {
  return [...roots, ...(indirectBuffer === null ? [] : [indirectBuffer.buffer as ArrayBuffer])];
}

/** The tree over the mesh that it was built of. */
export function readTree(built: SerializedBVH, mesh: MeshArrays): MeshBVH {
  return MeshBVH.deserialize(built, geometryOf(mesh), { setIndex: false });
}

/** The mesh as the tree sees it. Its face order is the mesh's, as long as trees are built with `indirect`. */
function geometryOf({ vertices, faces }: MeshArrays): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(vertices, 3));
  geometry.setIndex(new BufferAttribute(faces, 1));
  return geometry;
}
