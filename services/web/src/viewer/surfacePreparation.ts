/** What a mesh needs before it can be shown and painted, computed from its arrays: a worker's task. */
import { cornerNormals } from "../geometry/cornerNormals";
import { buildFaceGraph, type FaceGraphArrays } from "../geometry/faceGraph";
import { type FaceMeasures, measureFaces } from "../geometry/faceMeasures";
import { isSolid } from "../geometry/solid";

/** Faces to a chunk: those that are next to each other in the mesh's order mostly are on its surface, too. */
export const CHUNK_FACES = 256;

/** What rounding to float32 may take from a radius. */
const WIDER = 1.000_01;

export interface MeshArrays {
  readonly vertices: Float32Array;
  readonly faces: Uint32Array;
}

export interface PreparedSurface extends MeshArrays {
  readonly measures: FaceMeasures;
  readonly graph: FaceGraphArrays;
  /** (9m) The corners of each face, one after the other: a face has colours of its own. */
  readonly positions: Float32Array;
  /** (4c) Spheres around the faces of each chunk, middle and radius: what is out of sight is not drawn. */
  readonly spheres: Float32Array;
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
  const positions = cornerPositions(vertices, faces);
  return {
    vertices,
    faces,
    measures,
    graph,
    positions,
    spheres: chunkSpheres(positions),
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
  spheres,
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
    spheres,
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

function chunkSpheres(positions: Float32Array): Float32Array {
  const step = 9 * CHUNK_FACES;
  const spheres = new Float32Array(4 * Math.ceil(positions.length / step));
  for (let chunk = 0; chunk < spheres.length / 4; chunk += 1) {
    spheres.set(sphereAround(positions.subarray(chunk * step, (chunk + 1) * step)), 4 * chunk);
  }
  return spheres;
}

/** About the middle of the points' box: middle and radius. */
function sphereAround(points: Float32Array): [x: number, y: number, z: number, radius: number] {
  const [low, high] = [new Float64Array(3).fill(Infinity), new Float64Array(3).fill(-Infinity)];
  for (let at = 0; at < points.length; at += 1) {
    const value = points[at] as number;
    if (value < (low[at % 3] as number)) low[at % 3] = value;
    if (value > (high[at % 3] as number)) high[at % 3] = value;
  }
  const middle = (axis: 0 | 1 | 2) => ((low[axis] as number) + (high[axis] as number)) / 2;
  const half = (axis: 0 | 1 | 2) => ((high[axis] as number) - (low[axis] as number)) / 2;
  return [middle(0), middle(1), middle(2), Math.hypot(half(0), half(1), half(2)) * WIDER];
}
