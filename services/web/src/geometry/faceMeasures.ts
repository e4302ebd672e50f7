/**
 * Centroids, normals and the diagonal, by the specification of paint in docs/segmentation.md.
 *
 * Every step is +, −, × or √ on float64, rounded one by one in the order written: JavaScript's own arithmetic, as long as
 * nobody rearranges it. So the library and this page take the same faces.
 */

export interface FaceMeasures {
  readonly centroids: Float64Array;
  readonly crosses: Float64Array;
  readonly crossLengths: Float64Array;
  readonly diagonal: number;
  readonly centre: readonly [number, number, number];
}

export function measureFaces(vertices: Float32Array, faces: Uint32Array): FaceMeasures {
  const nFaces = faces.length / 3;
  const centroids = new Float64Array(faces.length);
  const crosses = new Float64Array(faces.length);
  const crossLengths = new Float64Array(nFaces);
  for (let face = 0; face < nFaces; face += 1) {
    const at = 3 * face;
    const a = 3 * (faces[at] as number);
    const b = 3 * (faces[at + 1] as number);
    const c = 3 * (faces[at + 2] as number);
    const [ax, ay, az] = [vertices[a] as number, vertices[a + 1] as number, vertices[a + 2] as number];
    const [bx, by, bz] = [vertices[b] as number, vertices[b + 1] as number, vertices[b + 2] as number];
    const [cx, cy, cz] = [vertices[c] as number, vertices[c + 1] as number, vertices[c + 2] as number];
    centroids[at] = (ax + bx + cx) / 3; // added from the left, as specified
    centroids[at + 1] = (ay + by + cy) / 3;
    centroids[at + 2] = (az + bz + cz) / 3;
    const [ux, uy, uz] = [bx - ax, by - ay, bz - az];
    const [vx, vy, vz] = [cx - ax, cy - ay, cz - az];
    const nx = uy * vz - uz * vy;
    const ny = uz * vx - ux * vz;
    const nz = ux * vy - uy * vx;
    crosses[at] = nx;
    crosses[at + 1] = ny;
    crosses[at + 2] = nz;
    crossLengths[face] = Math.sqrt(nx * nx + ny * ny + nz * nz);
  }
  return { centroids, crosses, crossLengths, ...measureBox(vertices, faces) };
}

function measureBox(vertices: Float32Array, faces: Uint32Array): Pick<FaceMeasures, "diagonal" | "centre"> {
  const low: [number, number, number] = [Infinity, Infinity, Infinity];
  const high: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (const corner of faces) {
    for (const axis of [0, 1, 2] as const) {
      const value = vertices[3 * corner + axis] as number;
      if (value < low[axis]) low[axis] = value;
      if (value > high[axis]) high[axis] = value;
    }
  }
  const [ex, ey, ez] = [high[0] - low[0], high[1] - low[1], high[2] - low[2]];
  return {
    diagonal: Math.sqrt(ex * ex + ey * ey + ez * ez),
    centre: [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2],
  };
}
