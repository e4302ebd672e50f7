/** What a mesh needs before it can be shown and painted, computed from its arrays: in a worker where there is one. */
import { BufferAttribute, BufferGeometry } from "three";
import { MeshBVH, type SerializedBVH } from "three-mesh-bvh";
import { cornerNormals } from "../geometry/cornerNormals";
import { buildFaceGraph, type FaceGraphArrays } from "../geometry/faceGraph";
import { type FaceMeasures, measureFaces } from "../geometry/faceMeasures";
import { isSolid } from "../geometry/solid";

export interface MeshArrays {
  readonly vertices: Float32Array;
  readonly faces: Uint32Array;
}

export interface Preparation {
  readonly measures: FaceMeasures;
  readonly graph: FaceGraphArrays;
  readonly normals: Int16Array;
  readonly bvh: SerializedBVH;
  readonly isSolid: boolean;
}

export function prepared({ vertices, faces }: MeshArrays): Preparation {
  const measures = measureFaces(vertices, faces);
  const bvh = new MeshBVH(pickGeometry(vertices, faces), { indirect: true });
  const graph = buildFaceGraph(faces, vertices.length / 3);
  return {
    measures,
    graph,
    isSolid: isSolid(vertices, faces, graph.opposite),
    normals: cornerNormals(vertices, faces, measures.crosses),
    bvh: { ...MeshBVH.serialize(bvh, { cloneBuffers: false }), index: null },
  };
}

/** The mesh as picking sees it. Its face order is the mesh's, as long as trees are built with `indirect`. */
export function pickGeometry(vertices: Float32Array, faces: Uint32Array): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(vertices, 3));
  geometry.setIndex(new BufferAttribute(faces, 1));
  return geometry;
}

/** The buffers of a preparation that can be handed over instead of copied. */
export function transferables({ measures, graph, normals, bvh }: Preparation): ArrayBuffer[] {
  const views = [
    measures.centroids,
    measures.crosses,
    measures.crossLengths,
    graph.opposite,
    graph.fans,
    graph.fanStart,
    graph.fanFaces,
    normals,
    ...(bvh.indirectBuffer === null ? [] : [bvh.indirectBuffer]),
  ];
  return [...views.map((view) => view.buffer as ArrayBuffer), ...bvh.roots];
}
