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
    for (let axis = 0; axis < 3; axis += 1) {
      atVertices[vertex + axis] = (atVertices[vertex + axis] as number) + (crosses[face + axis] as number);
    }
  }
  const normals = new Int16Array(4 * faces.length);
  for (let corner = 0; corner < faces.length; corner += 1) {
    const face = corner - (corner % 3);
    const own = unit(crosses, face);
    const round = unit(atVertices, 3 * (faces[corner] as number));
    const isRound = own[0] * round[0] + own[1] * round[1] + own[2] * round[2] > SMOOTHING_COSINE;
    const [x, y, z] = isRound ? round : own;
    normals[4 * corner] = x * FULL;
    normals[4 * corner + 1] = y * FULL;
    normals[4 * corner + 2] = z * FULL;
  }
  return normals;
}

function unit(values: Float64Array | Float32Array, at: number): [number, number, number] {
  const [x, y, z] = [values[at] as number, values[at + 1] as number, values[at + 2] as number];
  const length = Math.sqrt(x * x + y * y + z * z) || 1;
  return [x / length, y / length, z / length];
}
