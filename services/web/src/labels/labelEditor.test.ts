import { describe, expect, it } from "vitest";
import { strip } from "../geometry/testMeshes";
import { makeDelta } from "./deltaCodec";
import { LabelError } from "./errors";
import { LabelEditor } from "./labelEditor";
import type { Assign, Edit } from "./operations";

const assign = (first: number, count: number, label: number): Assign => ({
  kind: "assign",
  runs: [[first, count]],
  label,
});
const blank = () => new LabelEditor(strip(), new Uint16Array(6));

describe("an editor", () => {
  it("says what changed: not the faces that had the label", () => {
    const editor = blank();
    editor.apply(assign(1, 2, 4));
    const { faces, before, after } = editor.apply(assign(0, 3, 4));
    expect([[...faces], [...before], [...after]]).toEqual([[0], [0], [4]]);
  });

  it("takes back and does again", () => {
    const editor = blank();
    editor.apply(assign(1, 2, 4));
    editor.apply({ kind: "clear" });
    editor.apply({ kind: "undo" });
    expect([...editor.labels]).toEqual([0, 4, 4, 0, 0, 0]);
    editor.apply({ kind: "redo" });
    expect([...editor.labels]).toEqual([0, 0, 0, 0, 0, 0]);
    expect([editor.canUndo, editor.canRedo]).toEqual([true, false]);
  });

  it("takes an edit without effect for no step, which leaves redo as it was", () => {
    const editor = blank();
    editor.apply(assign(1, 2, 4));
    editor.apply({ kind: "undo" });
    expect(editor.apply({ kind: "clear" }).faces).toHaveLength(0);
    expect([editor.canUndo, editor.canRedo]).toEqual([false, true]);
  });

  it("has nothing to do again after another edit", () => {
    const editor = blank();
    editor.apply(assign(1, 2, 4));
    editor.apply({ kind: "undo" });
    editor.apply(assign(0, 1, 2));
    expect(editor.canRedo).toBe(false);
  });

  it("takes back as many steps as the library", () => {
    const editor = blank();
    for (let step = 0; step <= 200; step += 1) editor.apply(assign(0, 1, 1 + (step % 2)));
    for (let step = 0; step < 200; step += 1) editor.apply({ kind: "undo" });
    expect(editor.canUndo).toBe(false);
    expect(editor.apply({ kind: "undo" }).faces).toHaveLength(0);
    expect(editor.labels[0]).toBe(1); // the first step is past recall
  });

  it.each(["undo", "redo"] as const)("changes nothing for %s without a step", (kind) => {
    const editor = new LabelEditor(strip(), Uint16Array.of(1, 1, 0, 0, 2, 2));
    expect(editor.apply({ kind }).faces).toHaveLength(0);
    expect([editor.canUndo, editor.canRedo, ...editor.labels]).toEqual([false, false, 1, 1, 0, 0, 2, 2]);
  });

  it("paints only over the part that was there before the stroke", () => {
    const editor = blank();
    editor.apply(assign(2, 1, 1));
    const paint = { kind: "paint", seeds: [0], radius: 1, min_cosine: null, label: 3, only_over: 0 } as const;
    editor.apply(paint);
    expect([...editor.labels]).toEqual([3, 3, 1, 0, 0, 0]);
  });

  it("relabels a connected region", () => {
    const editor = blank();
    editor.apply(assign(2, 1, 1));
    editor.apply({ kind: "segment_wide", seed: 5, label: 2 });
    expect([...editor.labels]).toEqual([0, 0, 1, 2, 2, 2]);
  });

  it("previews without changing anything", () => {
    const editor = blank();
    expect([...editor.preview(assign(1, 2, 4)).faces]).toEqual([1, 2]);
    expect([...editor.labels]).toEqual([0, 0, 0, 0, 0, 0]);
  });

  it("does not follow the labels it was made from", () => {
    const labels = new Uint16Array(6);
    const editor = new LabelEditor(strip(), labels);
    labels[0] = 9;
    expect(editor.labels[0]).toBe(0);
  });
});

describe("an editor refuses, and changes nothing for", () => {
  const refused: [string, Edit, new () => Error][] = [
    ["a part that is not the collection's", assign(0, 1, 9), LabelError],
    ["a face outside the mesh", assign(5, 2, 1), RangeError],
    ["a region of a face outside the mesh", { kind: "segment_wide", seed: 6, label: 1 }, RangeError],
  ];

  it.each(refused)("%s", (_, edit, error) => {
    const editor = blank();
    editor.restrictTo([1, 2]);
    expect(() => editor.apply(edit)).toThrow(error);
    expect([editor.canUndo, ...editor.labels]).toEqual([false, 0, 0, 0, 0, 0, 0]);
  });

  it("a delta made for other labels", async () => {
    const editor = blank();
    const delta = await makeDelta("patches", {}, new Uint16Array(6), Uint16Array.of(0, 1, 1, 0, 0, 2));
    editor.apply(assign(4, 1, 1));
    expect(() => editor.apply(delta)).toThrow("made for other labels");
  });

  it("a delta of another mesh", async () => {
    const delta = await makeDelta("patches", {}, new Uint16Array(5), Uint16Array.of(0, 1, 1, 0, 0));
    expect(() => blank().apply(delta)).toThrow("for 5 faces must not be applied to 6");
  });

  it("a delta that gives a part that is not the collection's", async () => {
    const editor = blank();
    editor.restrictTo([1]);
    const delta = await makeDelta("patches", {}, editor.labels, Uint16Array.of(0, 1, 1, 0, 0, 2));
    expect(() => editor.apply(delta)).toThrow(LabelError);
  });

  it("labels of another mesh", () => {
    expect(() => new LabelEditor(strip(), new Uint16Array(5))).toThrow("5 for 6 faces");
  });
});
