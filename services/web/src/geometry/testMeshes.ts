/** Meshes for tests. */
import { SurfaceMesh } from "./surfaceMesh";

/** Six triangles in a row: each touches the one before and the one after. */
export function strip(): SurfaceMesh {
  const vertices = Array.from({ length: 8 }, (_, k) => [Math.floor(k / 2), k % 2, 0]).flat();
  const faces = Array.from({ length: 6 }, (_, k) => [k, k + 1, k + 2]).flat();
  return new SurfaceMesh(Float32Array.from(vertices), Uint32Array.from(faces), "strip");
}

/** Three triangles on one edge, and a fourth that touches only the first. */
export function fan(): SurfaceMesh {
  const vertices = [0, 0, 0, 0, 0, 1, 1, 0, 0.5, 0, 1, 0.5, -1, 0, 0.5, 1, 0, 1];
  return new SurfaceMesh(
    Float32Array.from(vertices),
    Uint32Array.from([0, 1, 2, 0, 1, 3, 1, 0, 4, 1, 2, 5]),
    "fan",
  );
}
