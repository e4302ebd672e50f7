/** Normals for shading: round where a surface is, sharp where it has a crease. */

/** Corners are shaded round where normals turn by less than 37°, as in the service's pictures. */
const SMOOTHING_COSINE = 0.8;
const FULL = 32_767;

/** Unit normals at each face's corners as signed 16-bit fractions, four to a corner (the last is 0): (12m). */
export function cornerNormals(vertices: Float32Array, faces: Uint32Array, crosses: Float64Array): Int16Array {
  const atVertices = new Float32Array(vertices.length);
  for (let edge = 0; edge < faces.length; edge += 1) {
    const vertex = 3 * (faces[edge] as number);
    const face = edge - (edge % 3);
    atVertices[vertex] = (atVertices[vertex] as number) + (crosses[face] as number);
    atVertices[vertex + 1] = (atVertices[vertex + 1] as number) + (crosses[face + 1] as number);
    atVertices[vertex + 2] = (atVertices[vertex + 2] as number) + (crosses[face + 2] as number);
  }
  toUnits(atVertices);
  const units = crosses.slice();
  toUnits(units);
  const normals = new Int16Array(4 * faces.length);
  for (let corner = 0; corner < faces.length; corner += 1) {
    const face = corner - (corner % 3);
    const vertex = 3 * (faces[corner] as number);
    let x = atVertices[vertex] as number;
    let y = atVertices[vertex + 1] as number;
    let z = atVertices[vertex + 2] as number;
    const ownX = units[face] as number;
    const ownY = units[face + 1] as number;
    const ownZ = units[face + 2] as number;
    if (!(ownX * x + ownY * y + ownZ * z > SMOOTHING_COSINE)) {
      x = ownX;
      y = ownY;
      z = ownZ;
    }
    const at = 4 * corner;
    normals[at] = x * FULL;
    normals[at + 1] = y * FULL;
    normals[at + 2] = z * FULL;
  }
  return normals;
}

/** Scales vectors (3n), in place; those of no length stay. */
function toUnits(vectors: Float64Array | Float32Array): void {
  for (let at = 0; at < vectors.length; at += 3) {
    const x = vectors[at] as number;
    const y = vectors[at + 1] as number;
    const z = vectors[at + 2] as number;
    const length = Math.sqrt(x * x + y * y + z * z) || 1;
    vectors[at] = x / length;
    vectors[at + 1] = y / length;
    vectors[at + 2] = z / length;
  }
}
