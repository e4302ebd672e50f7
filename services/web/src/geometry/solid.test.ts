import { describe, expect, it } from "vitest";
import { buildFaceGraph } from "./faceGraph";
import { isSolid } from "./solid";

const CORNERS = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];
const OUTWARD = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3];
const far = CORNERS.map((value) => value + 5);

function solid(vertices: number[], faces: number[]): boolean {
  const [points, corners] = [Float32Array.from(vertices), Uint32Array.from(faces)];
  return isSolid(points, corners, buildFaceGraph(corners, points.length / 3).opposite);
}

describe("a surface is solid", () => {
  it("where it is closed", () => expect(solid(CORNERS, OUTWARD)).toBe(true));

  it("where each of several is", () => {
    expect(solid([...CORNERS, ...far], [...OUTWARD, ...OUTWARD.map((k) => k + 4)])).toBe(true);
  });

  it("not where a face is missing", () => expect(solid(CORNERS, OUTWARD.slice(3))).toBe(false));

  it("not inside out", () => expect(solid(CORNERS, OUTWARD.toReversed())).toBe(false));

  it("not where one of several is inside out", () => {
    expect(solid([...CORNERS, ...far], [...OUTWARD, ...OUTWARD.toReversed().map((k) => k + 4)])).toBe(false);
  });

  it("not where a face is wound the other way", () => {
    expect(solid(CORNERS, [2, 0, 1, ...OUTWARD.slice(3)])).toBe(false);
  });

  it("not where three faces share an edge", () => {
    expect(solid([...CORNERS, 1, 1, 1], [...OUTWARD, 0, 1, 4])).toBe(false);
  });

  it("not where it has no volume", () => {
    expect(
      solid(
        CORNERS.map((value, k) => (k % 3 === 2 ? 0 : value)),
        OUTWARD,
      ),
    ).toBe(false);
  });
});
