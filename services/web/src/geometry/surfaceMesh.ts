/** A triangle mesh as it is served, and what painting needs of it, made when first asked for. */
import { buildFaceGraph, FaceGraph, type FaceGraphArrays } from "./faceGraph";
import { type FaceMeasures, measureFaces } from "./faceMeasures";

/**
 * vertices : (3n) float32, as served. faces : (3m) uint32, corners of each triangle. hash : the service's name for it.
 *
 * Throws RangeError when arrays are not whole triangles over these vertices.
 */
export class SurfaceMesh {
  readonly vertices: Float32Array;
  readonly faces: Uint32Array;
  readonly hash: string;
  readonly nVertices: number;
  readonly nFaces: number;
  #measures: FaceMeasures | undefined;
  #graph: FaceGraph | undefined;

  constructor(vertices: Float32Array, faces: Uint32Array, hash: string) {
    this.vertices = vertices;
    this.faces = faces;
    this.hash = hash;
    this.nVertices = vertices.length / 3;
    this.nFaces = faces.length / 3;
    if (!Number.isInteger(this.nVertices) || !Number.isInteger(this.nFaces) || this.nFaces === 0) {
      throw new RangeError(
        `a mesh must have whole points and triangles but has ${vertices.length}, ${faces.length}`,
      );
    }
    let largest = 0;
    for (let at = 0; at < faces.length; at += 1)
      if ((faces[at] as number) > largest) largest = faces[at] as number;
    if (largest >= this.nVertices) {
      throw new RangeError(`faces must name vertices 0 to ${this.nVertices - 1} but name ${largest}`);
    }
  }

  /** (3m) float64, `((a + b) + c) / 3` of the float32 corners. */
  get centroids(): Float64Array {
    return this.#measured().centroids;
  }

  /** (3m) float64, `(b − a) × (c − a)`: the normal, not scaled. */
  get crosses(): Float64Array {
    return this.#measured().crosses;
  }

  /** (m) float64, length of the cross product: twice the area, 0 for degenerate faces. */
  get crossLengths(): Float64Array {
    return this.#measured().crossLengths;
  }

  /** Length of the bounding box's diagonal, over the vertices that faces use. */
  get diagonal(): number {
    return this.#measured().diagonal;
  }

  /** The middle of the bounding box, over the vertices that faces use. */
  get centre(): readonly [number, number, number] {
    return this.#measured().centre;
  }

  get graph(): FaceGraph {
    this.#graph ??= new FaceGraph(buildFaceGraph(this.faces, this.nVertices));
    return this.#graph;
  }

  /** Takes what a worker computed of this very mesh. */
  adopt(measures: FaceMeasures, graph: FaceGraphArrays): void {
    this.#measures ??= measures;
    this.#graph ??= new FaceGraph(graph);
  }

  #measured(): FaceMeasures {
    this.#measures ??= measureFaces(this.vertices, this.faces);
    return this.#measures;
  }
}
