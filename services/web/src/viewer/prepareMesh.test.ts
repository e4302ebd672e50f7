import { Ray, Vector3 } from "three";
import { expect, it } from "vitest";
import { SurfaceMesh } from "../geometry/surfaceMesh";
import { strip } from "../geometry/testMeshes";
import { prepared, transferables } from "./meshPreparation";
import { prepareMesh } from "./prepareMesh";

const copy = ({ vertices, faces }: SurfaceMesh) => new SurfaceMesh(vertices.slice(), faces.slice(), "copy");

it("a prepared mesh is hit where its faces are, from both sides, in the mesh's own face order", async () => {
  const mesh = copy(strip());
  const faces = mesh.faces.slice();
  const { bvh } = await prepareMesh(mesh);
  expect(mesh.faces).toEqual(faces);
  for (let face = 0; face < mesh.nFaces; face += 1) {
    const above = new Vector3(...mesh.centroids.subarray(3 * face, 3 * face + 3)).setZ(5);
    expect(bvh.raycastFirst(new Ray(above, new Vector3(0, 0, -1)), 2)?.faceIndex).toBe(face);
    expect(bvh.raycastFirst(new Ray(above.setZ(-5), new Vector3(0, 0, 1)), 2)?.faceIndex).toBe(face);
  }
});

it("what is handed over from a worker is handed over once", () => {
  const buffers = transferables(prepared(copy(strip())));
  expect(new Set(buffers).size).toBe(buffers.length);
  expect(() => structuredClone(buffers, { transfer: buffers })).not.toThrow();
});
