import { describe, expect, it } from "vitest";
import { buildFaceGraph } from "./faceGraph";
import { fan, strip } from "./testMeshes";

const all = () => true;

describe("a face graph", () => {
  it("joins faces across their edges", () => {
    expect([...strip().graph.opposite.subarray(3, 6)]).toEqual([0, 2, -1]); // edges of face 1: 1–2, 2–3, 3–1
  });

  it("joins all faces of an edge of three to each other", () => {
    const { graph } = fan();
    const isOpen = (face: number) => face !== 1; // a chain by index would be cut here
    expect([...graph.grown(0, isOpen)]).toEqual([0, 2, 3]);
    expect([...graph.fans.subarray(0, 9)]).toEqual([0, -1, -1, 0, -1, -1, 0, -1, -1]);
  });

  it("takes an edge between a vertex and itself for none", () => {
    expect([...buildFaceGraph(Uint32Array.of(0, 0, 1, 0, 0, 2), 3).fanFaces]).toEqual([]);
  });

  it("grows nothing from a face that is not open", () => {
    expect(strip().graph.grown(2, (face) => face !== 2)).toHaveLength(0);
  });

  it("grows the same twice", () => {
    const { graph } = fan();
    expect(graph.grown(3, all)).toEqual(graph.grown(3, all));
  });

  it("asks about each face once", () => {
    const asked: number[] = [];
    fan().graph.grown(0, (face) => asked.push(face) > 0);
    expect(asked.sort()).toEqual([0, 1, 2, 3]);
  });

  it.each([-1, 6, 1.5, Number.NaN])("refuses face %s of six", (face) => {
    expect(() => strip().graph.grown(face, all)).toThrow("must be 0 to 5");
  });

  it("takes no more room than its faces where many meet in one edge", () => {
    const n = 20_000; // pairs of neighbours would be 200 million
    const faces = Uint32Array.from({ length: 3 * n }, (_, k) =>
      k % 3 === 2 ? 2 + Math.floor(k / 3) : k % 3,
    );
    const graph = buildFaceGraph(faces, n + 2);
    expect(graph.fanFaces).toHaveLength(n);
    expect([...graph.fanStart]).toEqual([0, n]);
  });
});
