import { describe, expect, it } from "vitest";
import { cornerNormals } from "./cornerNormals";
import { measureFaces } from "./faceMeasures";
import { SurfaceMesh } from "./surfaceMesh";
import { strip } from "./testMeshes";

const far = 2 ** 60; // one more or less is lost beside it

describe("a mesh", () => {
  it("adds corners in the specified order", () => {
    const mesh = new SurfaceMesh(
      Float32Array.of(1, far, far, far, 1, -far, -far, -far, 1),
      Uint32Array.of(0, 1, 2),
      "",
    );
    expect([...mesh.centroids]).toEqual([0, 0, 1 / 3]);
  });

  it("is as large as the vertices that faces use", () => {
    const vertices = Float32Array.of(0, 0, 0, 1, 0, 0, 1, 1, 0, 9, 9, 9);
    const mesh = new SurfaceMesh(vertices, Uint32Array.of(0, 1, 2), "");
    expect(mesh.diagonal).toBe(Math.sqrt(2));
    expect(mesh.centre).toEqual([0.5, 0.5, 0]);
  });

  it("has twice the area of each face, none where there is none", () => {
    const vertices = Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0);
    const mesh = new SurfaceMesh(vertices, Uint32Array.of(0, 1, 2, 0, 1, 3), "");
    expect([...mesh.crossLengths]).toEqual([1, 0]);
  });

  it.each([
    [Float32Array.of(0, 0), Uint32Array.of(0, 0, 0), "whole points"],
    [Float32Array.of(0, 0, 0), Uint32Array.of(), "whole points"],
    [Float32Array.of(0, 0, 0), Uint32Array.of(0, 0, 1), "vertices 0 to 0 but name 1"],
  ])("refuses arrays that are none", (vertices, faces, message) => {
    expect(() => new SurfaceMesh(vertices, faces, "")).toThrow(message);
  });

  it("keeps what a worker measured of it", () => {
    const { vertices, faces, graph } = strip();
    const mesh = new SurfaceMesh(vertices, faces, "");
    const measures = measureFaces(vertices, faces);
    mesh.adopt(measures, graph);
    expect(mesh.centroids).toBe(measures.centroids);
  });
});

describe("shading normals", () => {
  const normalsOf = (tilt: number) => {
    const vertices = Float32Array.of(0, 0, 0, 0, 1, 0, -1, 0, 0, Math.cos(tilt), 0, Math.sin(tilt));
    const faces = Uint32Array.of(0, 1, 2, 1, 0, 3);
    return cornerNormals(vertices, faces, measureFaces(vertices, faces).crosses);
  };

  it("are round where a surface turns a little", () => {
    const normals = normalsOf(0.3);
    expect(normals.subarray(0, 4)).toEqual(normals.subarray(16, 20)); // the same vertex in both faces
  });

  it("are each face's own at a crease", () => {
    const normals = normalsOf(1.6);
    expect(normals.subarray(0, 4)).toEqual(normals.subarray(8, 12));
    expect(normals.subarray(0, 4)).not.toEqual(normals.subarray(16, 20));
  });
});
