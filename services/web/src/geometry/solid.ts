/** Whether a surface has an inside that nobody looks at, so that only its outside need be drawn and picked. */

/**
 * Whether every component is closed, wound the same way round, and has its outside out.
 *
 * opposite : (3m) the face across each edge, of a `FaceGraph`.
 */
export function isSolid(vertices: Float32Array, faces: Uint32Array, opposite: Int32Array): boolean {
  const nFaces = faces.length / 3;
  const isSeen = new Uint8Array(nFaces);
  const stack = new Uint32Array(nFaces);
  for (let seed = 0; seed < nFaces; seed += 1) {
    if (isSeen[seed]) continue;
    isSeen[seed] = 1;
    stack[0] = seed;
    const origin = 3 * (faces[3 * seed] as number);
    let volume = 0;
    for (let height = 1; height > 0; ) {
      height -= 1;
      const face = stack[height] as number;
      volume += volumeBelow(vertices, faces, face, origin);
      for (let edge = 3 * face; edge < 3 * face + 3; edge += 1) {
        const across = opposite[edge] as number;
        if (across < 0 || !isRunBackward(faces, edge, across)) return false;
        if (!isSeen[across]) {
          isSeen[across] = 1;
          stack[height] = across;
          height += 1;
        }
      }
    }
    if (!(volume > 0)) return false;
  }
  return true;
}

/** Whether the face has the edge in the other direction, as neighbours that are wound alike do. */
function isRunBackward(faces: Uint32Array, edge: number, face: number): boolean {
  const from = faces[edge];
  const to = faces[edge % 3 === 2 ? edge - 2 : edge + 1];
  const a = faces[3 * face];
  const b = faces[3 * face + 1];
  const c = faces[3 * face + 2];
  return (a === to && b === from) || (b === to && c === from) || (c === to && a === from);
}

/** Six times the volume between a face and a point (the start of a vertex), below 0 where the face looks at it. */
function volumeBelow(vertices: Float32Array, faces: Uint32Array, face: number, origin: number): number {
  const a = 3 * (faces[3 * face] as number);
  const b = 3 * (faces[3 * face + 1] as number);
  const c = 3 * (faces[3 * face + 2] as number);
  const ox = vertices[origin] as number;
  const oy = vertices[origin + 1] as number;
  const oz = vertices[origin + 2] as number;
  const ax = (vertices[a] as number) - ox;
  const ay = (vertices[a + 1] as number) - oy;
  const az = (vertices[a + 2] as number) - oz;
  const bx = (vertices[b] as number) - ox;
  const by = (vertices[b + 1] as number) - oy;
  const bz = (vertices[b + 2] as number) - oz;
  const cx = (vertices[c] as number) - ox;
  const cy = (vertices[c + 1] as number) - oy;
  const cz = (vertices[c + 2] as number) - oz;
  return ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
}
