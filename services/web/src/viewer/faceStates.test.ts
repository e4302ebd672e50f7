import { describe, expect, it } from "vitest";
import { fan, strip } from "../geometry/testMeshes";
import { FaceStates, HIGHLIGHTED, LABEL_BORDER, PATCH_BORDER } from "./faceStates";

const PALETTE = {
  unlabelled: "#808080",
  colours: new Map([
    [1, "#ff0000"],
    [2, "#0000ff"],
  ]),
};

function shown(mesh = strip()) {
  let nTouched = 0;
  const states = new FaceStates(mesh.graph, 64, () => {
    nTouched += 1;
  });
  states.setPalette(PALETTE);
  const colour = (face: number) => [...states.bytes.subarray(4 * face, 4 * face + 3)];
  const bits = (face: number, mask: number) => (states.bytes[4 * face + 3] as number) & mask;
  return { states, colour, bits, nTouched: () => nTouched };
}

describe("faces", () => {
  it("have the colours of their parts, grey where there is none", () => {
    const { states, colour } = shown();
    states.setLabels(Uint16Array.of(0, 1, 2, 9, 0, 0));
    expect([0, 1, 2, 3].map(colour)).toEqual([
      [128, 128, 128],
      [255, 0, 0],
      [0, 0, 255],
      [128, 128, 128],
    ]);
  });

  it("follow labels that changed, with the borders of their neighbours", () => {
    const labels = new Uint16Array(6);
    const [changing, whole] = [shown(), shown()];
    changing.states.setLabels(labels);
    labels.set([1, 1], 2);
    changing.states.recolour(Uint32Array.of(2, 3));
    whole.states.setLabels(labels);
    expect(changing.states.bytes).toEqual(whole.states.bytes);
    expect([0, 1, 2, 3, 4, 5].map((face) => changing.bits(face, LABEL_BORDER * 7) > 0)).toEqual([
      false,
      true,
      true,
      true,
      true,
      false,
    ]);
  });

  it("have a border round an edge of three faces where not all are of one part", () => {
    const labels = new Uint16Array(4);
    const { states, bits } = shown(fan());
    states.setLabels(labels);
    labels[2] = 1;
    states.recolour(Uint32Array.of(2));
    expect([0, 1, 2].map((face) => bits(face, LABEL_BORDER * 7))).toEqual([1, 1, 1]);
    labels[2] = 0;
    states.recolour(Uint32Array.of(2));
    expect([0, 1, 2].map((face) => bits(face, LABEL_BORDER * 7))).toEqual([0, 0, 0]);
  });

  it("are tinted by patch where they have no part, and bordered everywhere", () => {
    const { states, colour, bits } = shown();
    states.setLabels(Uint16Array.of(0, 0, 0, 1, 1, 1));
    states.setPatches(Uint32Array.of(0, 0, 1, 1, 2, 2));
    expect(colour(0)).not.toEqual(colour(2));
    expect(colour(3)).toEqual([255, 0, 0]);
    expect(bits(4, PATCH_BORDER * 7)).not.toBe(0);
    states.setPatches(null);
    expect(colour(0)).toEqual([128, 128, 128]);
    expect(bits(4, PATCH_BORDER * 7)).toBe(0);
    expect(bits(3, LABEL_BORDER * 7)).not.toBe(0);
  });

  it("show a heat map instead of parts while there is one", () => {
    const { states, colour } = shown();
    states.setHeat(Float32Array.of(0, 0.5, 1, 0, 0, 0));
    expect(colour(0)).not.toEqual(colour(2));
    states.setHeat(null);
    expect(colour(2)).toEqual([128, 128, 128]);
  });

  it("are highlighted until others are", () => {
    const { states, bits } = shown();
    states.highlight(Uint32Array.of(1));
    states.highlightMore(Uint32Array.of(2));
    expect([0, 1, 2].map((face) => bits(face, HIGHLIGHTED) > 0)).toEqual([false, true, true]);
    states.highlight(Uint32Array.of(0));
    expect([0, 1, 2].map((face) => bits(face, HIGHLIGHTED) > 0)).toEqual([true, false, false]);
    states.highlight(null);
    expect(bits(0, HIGHLIGHTED)).toBe(0);
  });

  it("say when they must be drawn anew", () => {
    const { states, nTouched } = shown();
    const before = nTouched();
    states.recolour(new Uint32Array(0));
    expect(nTouched()).toBe(before);
    states.recolour(Uint32Array.of(1));
    expect(nTouched()).toBeGreaterThan(before);
  });
});
