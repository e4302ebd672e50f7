import { expect, it } from "vitest";
import { strip } from "../geometry/testMeshes";
import { preparedSurface } from "./surfacePreparation";

it("a prepared surface has the corners of each face, one after the other", () => {
  const mesh = strip();
  const { positions } = preparedSurface(mesh);
  mesh.faces.forEach((vertex, corner) => {
    expect(positions.subarray(3 * corner, 3 * corner + 3)).toEqual(
      mesh.vertices.subarray(3 * vertex, 3 * vertex + 3),
    );
  });
});
