/** What a mesh needs before it can be shown and painted, computed from its arrays: a worker's task. */
import { cornerNormals } from "../geometry/cornerNormals";
import { buildFaceGraph, type FaceGraphArrays } from "../geometry/faceGraph";
import { type FaceMeasures, measureFaces } from "../geometry/faceMeasures";
import { isSolid } from "../geometry/solid";

export interface MeshArrays {
  readonly vertices: Float32Array;
  readonly faces: Uint32Array;
}

export interface PreparedSurface extends MeshArrays {
  readonly measures: FaceMeasures;
  readonly graph: FaceGraphArrays;
  /** (9m) The corners of each face, one after the other: a face has colours of its own. */
  readonly positions: Float32Array;
  /** (3k) The vertices that faces use, each once: what a view has to frame. */
  readonly outline: Float32Array;
  /** Shading normals, four int16 to a corner. */
  readonly normals: Int16Array;
  /** Nobody looks at its inside: only the outside is drawn and picked. */
  readonly isSolid: boolean;
}

/** Throws nothing for arrays that a `SurfaceMesh` takes. */
export function preparedSurface({ vertices, faces }: MeshArrays): PreparedSurface {
  const measures = measureFaces(vertices, faces);
  const graph = buildFaceGraph(faces, vertices.length / 3);
  return {
    vertices,
    faces,
    measures,
    graph,
    positions: cornerPositions(vertices, faces),
    outline: usedVertices(vertices, faces),
    normals: cornerNormals(vertices, faces, measures.crosses),
    isSolid: isSolid(vertices, faces, graph.opposite),
  };
}

/** The buffers that can be handed over instead of copied. Those of the mesh itself stay, for its search tree. */
export function transferables({
  measures,
  graph,
  positions,
  outline,
  normals,
}: PreparedSurface): ArrayBuffer[] {
  const views = [
    measures.centroids,
    measures.crosses,
    measures.crossLengths,
    graph.opposite,
    graph.fans,
    graph.fanStart,
    graph.fanFaces,
    positions,
    outline,
    normals,
  ];
  return views.map((view) => view.buffer as ArrayBuffer);
}

function cornerPositions(vertices: Float32Array, faces: Uint32Array): Float32Array {
  const positions = new Float32Array(3 * faces.length);
  for (let corner = 0; corner < faces.length; corner += 1) {
    const vertex = 3 * (faces[corner] as number);
    const at = 3 * corner;
    positions[at] = vertices[vertex] as number;
    positions[at + 1] = vertices[vertex + 1] as number;
    positions[at + 2] = vertices[vertex + 2] as number;
  }
  return positions;
}

function usedVertices(vertices: Float32Array, faces: Uint32Array): Float32Array {
  const isUsed = new Uint8Array(vertices.length / 3);
  for (let corner = 0; corner < faces.length; corner += 1) isUsed[faces[corner] as number] = 1;
  const used = new Float32Array(vertices.length);
  let end = 0;
  for (let vertex = 0; vertex < isUsed.length; vertex += 1) {
    if (isUsed[vertex] === 0) continue;
    used[end] = vertices[3 * vertex] as number;
    used[end + 1] = vertices[3 * vertex + 1] as number;
    used[end + 2] = vertices[3 * vertex + 2] as number;
    end += 3;
  }
  return used.slice(0, end);
}
