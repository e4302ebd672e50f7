import { Ray, Vector3 } from "three";
import { expect, it } from "vitest";
import { strip } from "../geometry/testMeshes";
import { buffersOf, builtTree, readTree } from "./searchTree";
import { preparedSurface, transferables } from "./surfacePreparation";

it("a face is hit where it is, from both sides, in the mesh's own face order", () => {
  const mesh = strip();
  const faces = mesh.faces.slice();
  const tree = readTree(builtTree(mesh), mesh);
  expect(mesh.faces).toEqual(faces);
  for (let face = 0; face < mesh.nFaces; face += 1) {
    const above = new Vector3(...mesh.centroids.subarray(3 * face, 3 * face + 3)).setZ(5);
    expect(tree.raycastFirst(new Ray(above, new Vector3(0, 0, -1)), 2)?.faceIndex).toBe(face);
    expect(tree.raycastFirst(new Ray(above.setZ(-5), new Vector3(0, 0, 1)), 2)?.faceIndex).toBe(face);
  }
});

it("what is handed over from a worker is handed over once, and leaves the mesh there", () => {
  const mesh = strip();
  const buffers = [...transferables(preparedSurface(mesh)), ...buffersOf(builtTree(mesh))];
  expect(new Set(buffers).size).toBe(buffers.length);
  expect(() => structuredClone(buffers, { transfer: buffers })).not.toThrow();
  expect(mesh.faces.length).toBe(18);
});
