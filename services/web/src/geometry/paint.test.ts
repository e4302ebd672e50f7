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

/** A grid of 3 by 4 squares of side 3, each of two triangles: its diagonal is 15, its centroids are whole. */
function grid(): SurfaceMesh {
  const vertices = Array.from({ length: 20 }, (_, k) => [3 * (k % 4), 3 * Math.floor(k / 4), 0]).flat();
  const corner = (square: number) => Math.floor(square / 3) * 4 + (square % 3);
  const faces = Array.from({ length: 12 }, (_, square) => {
    const a = corner(square);
    return [a, a + 1, a + 5, a, a + 5, a + 4];
  });
  return new SurfaceMesh(Float32Array.from(vertices), Uint32Array.from(faces.flat()), "grid");
}

describe("a click", () => {
  it("takes faces exactly at the rim", () => {
    expect(grid().diagonal * 0.2).toBe(3);
    const taken = [...paintedFaces(grid(), [8], { radius: 0.2, min_cosine: null })];
    expect(taken).toEqual(expect.arrayContaining([2, 6, 8, 10, 14])); // the same half of the squares around
    expect(taken).not.toContain(0);
  });

  it("takes the clicked face whatever the brush, however its own cosine is rounded", () => {
    const { mesh } = golden("scraps.json");
    for (let seed = 0; seed < mesh.nFaces; seed += 1) {
      expect(paintedFaces(mesh, [seed], { radius: 1e-9, min_cosine: 1 })).toContain(seed);
    }
  });

  it("takes faces exactly at the limit of the angle", () => {
    const { mesh } = golden("fold.json");
    const flat = paintedFaces(mesh, [27], { radius: 1, min_cosine: 1 });
    expect(flat.length).toBeGreaterThan(1);
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
