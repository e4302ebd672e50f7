import { expect, it } from "vitest";
import { strip } from "../geometry/testMeshes";
import { CHUNK_FACES, preparedSurface } from "./surfacePreparation";

it("a prepared surface has the corners of each face, one after the other", () => {
  const mesh = strip();
  const { positions } = preparedSurface(mesh);
  mesh.faces.forEach((vertex, corner) => {
    expect(positions.subarray(3 * corner, 3 * corner + 3)).toEqual(
      mesh.vertices.subarray(3 * vertex, 3 * vertex + 3),
    );
  });
});

it("every chunk of faces lies in its sphere", () => {
  const n = 2 * CHUNK_FACES + 10;
  const vertices = Float32Array.from({ length: 3 * (n + 2) }, (_, at) => Math.sin(at * at));
  const faces = Uint32Array.from({ length: 3 * n }, (_, at) => Math.floor(at / 3) + (at % 3));
  const { spheres, positions } = preparedSurface({ vertices, faces });
  expect(spheres.length).toBe(4 * 3);
  for (let at = 0; at < positions.length; at += 3) {
    const chunk = 4 * Math.floor(at / (9 * CHUNK_FACES));
    const [x, y, z] = [0, 1, 2].map(
      (axis) => (positions[at + axis] as number) - (spheres[chunk + axis] as number),
    );
    expect(Math.hypot(x as number, y as number, z as number)).toBeLessThanOrEqual(
      spheres[chunk + 3] as number,
    );
  }
});

it("what a view frames are the vertices that faces use, each once", () => {
  const vertices = Float32Array.of(9, 9, 9, 0, 0, 0, 1, 0, 0, 8, 8, 8, 0, 1, 0);
  const { outline } = preparedSurface({ vertices, faces: Uint32Array.of(1, 2, 4, 4, 2, 1) });
  expect(outline).toEqual(Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0));
});
