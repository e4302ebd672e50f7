/** What a brush takes, held to the golden strokes that the library is held to: tests/golden/paint. */
import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { Drag, paintedFaces } from "./paint";
import { SurfaceMesh } from "./surfaceMesh";

const FOLDER = new URL("../../../../tests/golden/paint/", import.meta.url);
const NAMES = readdirSync(FOLDER).filter((name) => name.endsWith(".json"));

interface Case {
  seeds: number[];
  radius: number;
  min_cosine: number | null;
  closed: number[] | null;
  faces: number[];
}

function golden(name: string): { mesh: SurfaceMesh; cases: Case[] } {
  const { vertices, faces, cases } = JSON.parse(readFileSync(new URL(name, FOLDER), "utf8"));
  return {
    mesh: new SurfaceMesh(Float32Array.from(vertices.flat()), Uint32Array.from(faces.flat()), name),
    cases,
  };
}

describe("golden paint strokes", () => {
  it("are there", () => expect(NAMES).toHaveLength(6));

  it.each(NAMES)("%s takes the recorded faces", (name) => {
    const { mesh, cases } = golden(name);
    for (const { seeds, radius, min_cosine, closed, faces } of cases) {
      const shut = new Set(closed ?? []);
      const painted = paintedFaces(mesh, seeds, { radius, min_cosine }, (face) => !shut.has(face));
      expect([...painted], JSON.stringify({ seeds, radius, min_cosine })).toEqual(faces);
    }
  });
});

describe("a drag", () => {
  const { mesh } = golden("fold.json");

  it("adds with each click what the clicks before did not take", () => {
    const drag = new Drag(mesh, { radius: 0.2, min_cosine: null });
    const added = [...drag.click(0), ...drag.click(5), ...drag.click(0)];
    expect(new Set(added).size).toBe(added.length);
    expect(added.sort((a, b) => a - b)).toEqual([
      ...paintedFaces(mesh, [0, 5], { radius: 0.2, min_cosine: null }),
    ]);
  });

  it("keeps the clicked faces in order, each once", () => {
    const drag = new Drag(mesh, { radius: 0.2, min_cosine: null });
    for (const seed of [5, 0, 5]) drag.click(seed);
    expect(drag.seeds).toEqual([5, 0]);
  });

  it("refuses a face outside the mesh", () => {
    expect(() => paintedFaces(mesh, [mesh.nFaces], { radius: 0.2, min_cosine: null })).toThrow(RangeError);
  });
});
