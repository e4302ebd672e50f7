/**
 * Which faces touch across edges, as `partwise.segmentation.face_graph` defines it.
 *
 * Two faces touch when they share an edge: two different vertex indices. An edge of more than two faces (a fan) joins
 * all of them to each other. Vertices at one place under two indices join nothing.
 */

const NONE = -1;

/** Adjacency as arrays, which a worker can hand over. */
export interface FaceGraphArrays {
  /** (3m) The face across each edge, −1 at a border and at fans. Edge k of a face is from corner k to k + 1. */
  readonly opposite: Int32Array;
  /** (3m) Which fan each edge is, −1 where it has at most two faces. */
  readonly fans: Int32Array;
  /** (q + 1) Where in `fanFaces` each fan begins. */
  readonly fanStart: Uint32Array;
  readonly fanFaces: Uint32Array;
}

/** Adjacency over the m faces of a mesh, ready to grow regions. */
export class FaceGraph implements FaceGraphArrays {
  readonly nFaces: number;
  readonly opposite: Int32Array;
  readonly fans: Int32Array;
  readonly fanStart: Uint32Array;
  readonly fanFaces: Uint32Array;
  // Kept between calls, so that growing costs what the region costs: an entry is valid if it has this call's number.
  readonly #seen: Uint32Array;
  readonly #spentFans: Uint32Array;
  readonly #queue: Uint32Array;
  #call = 0;

  constructor(arrays: FaceGraphArrays) {
    this.nFaces = arrays.opposite.length / 3;
    this.opposite = arrays.opposite;
    this.fans = arrays.fans;
    this.fanStart = arrays.fanStart;
    this.fanFaces = arrays.fanFaces;
    this.#seen = new Uint32Array(this.nFaces);
    this.#spentFans = new Uint32Array(this.fanStart.length - 1);
    this.#queue = new Uint32Array(this.nFaces);
  }

  /** Throws RangeError unless `face` is one of the mesh. */
  checkFace(face: number): void {
    if (!Number.isInteger(face) || face < 0 || face >= this.nFaces) {
      throw new RangeError(
        `a face must be 0 to ${this.nFaces - 1} but is ${face}; was it chosen on another mesh?`,
      );
    }
  }

  /**
   * Faces reached from `seed` breadth-first through open faces, ascending; none when the seed is not open.
   *
   * `isOpen` is asked about each face at most once, and must not grow another region on this graph.
   */
  grown(seed: number, isOpen: (face: number) => boolean): Uint32Array {
    this.checkFace(seed);
    this.#call += 1;
    const [seen, queue, opposite, call] = [this.#seen, this.#queue, this.opposite, this.#call];
    let end = 0;
    const visit = (face: number) => {
      if (seen[face] === call) return;
      seen[face] = call;
      if (isOpen(face)) queue[end++] = face;
    };
    visit(seed);
    for (let begin = 0; begin < end; begin += 1) {
      const first = 3 * (queue[begin] as number);
      for (let edge = first; edge < first + 3; edge += 1) {
        const across = opposite[edge] as number;
        if (across !== NONE) visit(across);
        else if (this.#spentFans.length > 0) this.#visitFan(this.fans[edge] as number, visit);
      }
    }
    return queue.slice(0, end).sort();
  }

  /** A fan of q faces costs q, never q²: its faces are asked for once. */
  #visitFan(fan: number, visit: (face: number) => void): void {
    if (fan === NONE || this.#spentFans[fan] === this.#call) return;
    this.#spentFans[fan] = this.#call;
    const end = this.fanStart[fan + 1] as number;
    for (let place = this.fanStart[fan] as number; place < end; place += 1)
      visit(this.fanFaces[place] as number);
  }
}

/** Adjacency of triangles `faces` (3m) over `nVertices` vertices. Takes time linear in both. */
export function buildFaceGraph(faces: Uint32Array, nVertices: number): FaceGraphArrays {
  const { order, low, high } = sortedEdges(faces, nVertices);
  const opposite = new Int32Array(faces.length).fill(NONE);
  const fans = new Int32Array(faces.length).fill(NONE);
  const fanStart = [0];
  const fanFaces: number[] = [];
  for (let begin = 0; begin < order.length; ) {
    const edge = order[begin] as number;
    let end = begin + 1;
    while (end < order.length && isSameEdge(low, high, edge, order[end] as number)) end += 1;
    if (end - begin === 2) {
      const other = order[begin + 1] as number;
      opposite[edge] = Math.floor(other / 3);
      opposite[other] = Math.floor(edge / 3);
    } else if (end - begin > 2) {
      for (let place = begin; place < end; place += 1) {
        fans[order[place] as number] = fanStart.length - 1;
        fanFaces.push(Math.floor((order[place] as number) / 3));
      }
      fanStart.push(fanFaces.length);
    }
    begin = end;
  }
  return { opposite, fans, fanStart: Uint32Array.from(fanStart), fanFaces: Uint32Array.from(fanFaces) };
}

function isSameEdge(low: Uint32Array, high: Uint32Array, edge: number, other: number): boolean {
  return low[edge] === low[other] && high[edge] === high[other];
}

/** Edges in order of their lower, then their higher vertex, without those between a vertex and itself. */
function sortedEdges(faces: Uint32Array, nVertices: number) {
  const low = new Uint32Array(faces.length);
  const high = new Uint32Array(faces.length);
  const edges = new Uint32Array(faces.length);
  let n = 0;
  for (let edge = 0; edge < faces.length; edge += 1) {
    const from = faces[edge] as number;
    const to = faces[edge % 3 === 2 ? edge - 2 : edge + 1] as number;
    low[edge] = Math.min(from, to);
    high[edge] = Math.max(from, to);
    if (from !== to) edges[n++] = edge;
  }
  const byHigh = countingSorted(edges.subarray(0, n), high, nVertices);
  return { order: countingSorted(byHigh, low, nVertices), low, high };
}

/** `items` in ascending order of their keys, those of equal key in the order they had. Keys are below `nKeys`. */
function countingSorted(items: Uint32Array, keys: Uint32Array, nKeys: number): Uint32Array {
  const end = new Uint32Array(nKeys); // of each key's items; going backwards makes it their place
  for (const item of items) {
    const key = keys[item] as number;
    end[key] = (end[key] as number) + 1;
  }
  for (let key = 1; key < nKeys; key += 1) end[key] = (end[key] as number) + (end[key - 1] as number);
  const sorted = new Uint32Array(items.length);
  for (let place = items.length - 1; place >= 0; place -= 1) {
    const item = items[place] as number;
    const key = keys[item] as number;
    const at = (end[key] as number) - 1;
    end[key] = at;
    sorted[at] = item;
  }
  return sorted;
}
