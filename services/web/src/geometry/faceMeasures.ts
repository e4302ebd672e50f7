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
    const ax = vertices[a] as number;
    const ay = vertices[a + 1] as number;
    const az = vertices[a + 2] as number;
    const bx = vertices[b] as number;
    const by = vertices[b + 1] as number;
    const bz = vertices[b + 2] as number;
    const cx = vertices[c] as number;
    const cy = vertices[c + 1] as number;
    const cz = vertices[c + 2] as number;
    centroids[at] = (ax + bx + cx) / 3; // added from the left, as specified
    centroids[at + 1] = (ay + by + cy) / 3;
    centroids[at + 2] = (az + bz + cz) / 3;
    const ux = bx - ax;
    const uy = by - ay;
    const uz = bz - az;
    const vx = cx - ax;
    const vy = cy - ay;
    const vz = cz - az;
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
  const [low, high] = [new Float64Array(3).fill(Infinity), new Float64Array(3).fill(-Infinity)];
  for (let corner = 0; corner < faces.length; corner += 1) {
    const vertex = 3 * (faces[corner] as number);
    for (let axis = 0; axis < 3; axis += 1) {
      const value = vertices[vertex + axis] as number;
      if (value < (low[axis] as number)) low[axis] = value;
      if (value > (high[axis] as number)) high[axis] = value;
    }
  }
  const [lx, ly, lz] = low as unknown as [number, number, number];
  const [hx, hy, hz] = high as unknown as [number, number, number];
  const [ex, ey, ez] = [hx - lx, hy - ly, hz - lz];
  return {
    diagonal: Math.sqrt(ex * ex + ey * ey + ez * ez),
    centre: [(lx + hx) / 2, (ly + hy) / 2, (lz + hz) / 2],
  };
}
