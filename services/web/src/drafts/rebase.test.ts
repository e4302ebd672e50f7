import { describe, expect, it } from "vitest";
import { SurfaceMesh } from "../geometry/surfaceMesh";
import { makeDelta } from "../labels/deltaCodec";
import { LabelEditor } from "../labels/labelEditor";
import type { Operation } from "../labels/operations";
import { replayOnto } from "../labels/replay";
import { newStroke } from "../labels/strokes";
import { onTop } from "./rebase";

const N_FACES = 6;
const place = { sequence: 9, base_revision: null, author_id: 2 };

/** A strip of triangles: each touches the next. */
function strip(): SurfaceMesh {
  const vertices = Float32Array.from({ length: 3 * (N_FACES + 2) }, (_, at) => {
    const vertex = Math.floor(at / 3);
    return [vertex / 2, vertex % 2, 0][at % 3] as number;
  });
  const faces = Uint32Array.from({ length: 3 * N_FACES }, (_, at) => Math.floor(at / 3) + (at % 3));
  return new SurfaceMesh(vertices, faces, "strip");
}

function after(...operations: Operation[]): LabelEditor {
  const editor = new LabelEditor(strip(), new Uint16Array(N_FACES));
  for (const operation of operations) editor.apply(operation);
  return editor;
}

const assign = (first: number, count: number, label: number): Operation => ({
  kind: "assign",
  runs: [[first, count]],
  label,
});
const strokesOf = (operations: Operation[]) => operations.map((each) => newStroke(each, place));

async function merged(before: Operation[], mine: Operation[], theirs: Operation[]) {
  const strokes = await onTop(after(...before), strokesOf(mine), after(...before, ...theirs), place);
  const replayed = after(...before, ...theirs);
  await replayOnto(replayed, strokes);
  return { strokes, labels: [...replayed.labels] };
}

describe("strokes put on top of others", () => {
  it("win where they changed something, and leave the rest", async () => {
    const { labels } = await merged([], [assign(0, 3, 1)], [assign(2, 3, 2)]);
    expect(labels).toEqual([1, 1, 1, 2, 2, 0]);
  });

  it("follow on the log they are for", async () => {
    const { strokes } = await merged([], [assign(0, 1, 1), assign(1, 1, 1)], []);
    expect(strokes.map((each) => each.sequence)).toEqual([9, 10]);
  });

  it("take the faces that the person saw, not those that a region has now", async () => {
    const wide: Operation = { kind: "segment_wide", seed: 5, label: 3 };
    const { labels } = await merged([assign(0, 3, 1)], [wide], [{ kind: "clear" }]);
    expect(labels).toEqual([0, 0, 0, 3, 3, 3]);
  });

  it("leave out what was taken back", async () => {
    const { strokes, labels } = await merged(
      [],
      [assign(0, 3, 1), { kind: "undo" }, assign(5, 1, 4)],
      [assign(0, 1, 2)],
    );
    expect(labels).toEqual([2, 0, 0, 0, 0, 4]);
    expect(strokes).toHaveLength(1);
  });

  it("have what was taken back and done again", async () => {
    const { labels } = await merged([], [assign(0, 3, 1), { kind: "undo" }, { kind: "redo" }], []);
    expect(labels).toEqual([1, 1, 1, 0, 0, 0]);
  });

  it("take back what came before both sides", async () => {
    const { labels } = await merged([assign(0, 2, 1)], [{ kind: "undo" }], [assign(5, 1, 2)]);
    expect(labels).toEqual([0, 0, 0, 0, 0, 2]);
  });

  it("bring results of solvers to labels that these were not made for", async () => {
    const before = after();
    const delta = await makeDelta("boundary_refinement", {}, before.labels, Uint16Array.of(1, 1, 2, 2, 3, 3));
    const { labels } = await merged([], [delta], [assign(0, 6, 5)]);
    expect(labels).toEqual([1, 1, 2, 2, 3, 3]);
  });

  it("are none where nothing would change", async () => {
    const { strokes } = await merged([], [assign(0, 3, 1)], [assign(0, 6, 1)]);
    expect(strokes).toEqual([]);
  });
});
