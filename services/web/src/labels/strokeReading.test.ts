import { describe, expect, it } from "vitest";
import { strip } from "../geometry/testMeshes";
import { makeDelta } from "./deltaCodec";
import type { Operation } from "./operations";
import { partShares } from "./partShares";
import { replayedLog, replayOnto } from "./replay";
import { labelsSha256 } from "./sha256";
import { readLog, readOperation, readStroke, type StrokeLog } from "./strokeReading";
import { newId, newStroke } from "./strokes";

const PLACE = { sequence: 0, base_revision: null, author_id: 2 };
const PAINT = { kind: "paint", seeds: [1], radius: 0.1, min_cosine: null, label: 3, only_over: 0 } as const;
const stroke = (operation: Operation = PAINT) => JSON.parse(JSON.stringify(newStroke(operation, PLACE)));

describe("a stroke", () => {
  it("is an object of its operation, its place, an id and a time", () => {
    const { id, at, ...rest } = newStroke(PAINT, { ...PLACE, sequence: 4, base_revision: 17 });
    expect(rest).toEqual({ v: 1, ...PAINT, sequence: 4, base_revision: 17, author_id: 2 });
    expect(id).toMatch(/^[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}$/);
    expect(at).toMatch(/^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$/);
  });

  it("has an id of its own", () => expect(newId()).not.toBe(newId()));

  it("of a delta keeps the payload, not what it says", async () => {
    const delta = await makeDelta("patches", { n: 3 }, new Uint16Array(2), Uint16Array.of(0, 1));
    expect(stroke(delta)).not.toHaveProperty("changed");
    expect(await readOperation(readStroke(stroke(delta)))).toEqual(delta);
  });

  it.each([
    PAINT,
    { kind: "assign", runs: [[1, 2]], label: 1 },
    { kind: "segment_wide", seed: 1, label: 0 },
    { kind: "clear" },
    { kind: "undo" },
    { kind: "redo" },
  ] as Operation[])("is read as it was written: $kind", (operation) => {
    const written = stroke(operation);
    expect(readStroke(written)).toEqual(written);
  });

  it.each([
    ["must be an object", () => null],
    ["must have version 0 to 1 but has 2", () => ({ ...stroke(), v: 2 })],
    ["kind fly is not known", () => ({ ...stroke(), kind: "fly" })],
    ["must have author_id", () => ({ ...stroke(), author_id: undefined })],
    ["unknown keys mood", () => ({ ...stroke(), mood: "good" })],
    ["seeds of a stroke must be a list of whole numbers", () => ({ ...stroke(), seeds: [0.5] })],
    ["radius of a stroke must be a finite number", () => ({ ...stroke(), radius: "0.1" })],
    ["label of a stroke must be a whole number", () => ({ ...stroke(), label: 1.5 })],
    ["id of a stroke must be text", () => ({ ...stroke(), id: 5 })],
    ["a list of pairs", () => ({ ...stroke({ kind: "assign", runs: [], label: 1 }), runs: [[1]] })],
    [
      "parameters of a stroke must be an object",
      () => ({ ...stroke(), kind: "delta", source: "patches", parameters: 1 }),
    ],
    ["source magic is not known", () => ({ ...stroke(), kind: "delta", source: "magic" })],
  ])("is refused: %s", (message, document) => {
    expect(() => readStroke(JSON.parse(JSON.stringify(document())))).toThrow(message);
  });
});

describe("a log", () => {
  const log = (...operations: Operation[]): StrokeLog => ({
    mesh_hash: "strip",
    n_faces: 6,
    base_revision: null,
    base_sha256: labelsSha256(new Uint16Array(6)),
    strokes: operations.map((operation, sequence) => newStroke(operation, { ...PLACE, sequence })),
  });
  const BLANK = new Uint16Array(6);

  it("is replayed to an editor that can go on", async () => {
    const editor = await replayedLog(
      strip(),
      BLANK,
      log({ kind: "assign", runs: [[1, 2]], label: 1 }, { kind: "undo" }),
    );
    editor.apply({ kind: "redo" });
    expect([...editor.labels]).toEqual([0, 1, 1, 0, 0, 0]);
  });

  it("goes on an editor that has some of it", async () => {
    const editor = await replayedLog(strip(), BLANK, log({ kind: "assign", runs: [[1, 2]], label: 1 }));
    await replayOnto(editor, [newStroke({ kind: "undo" }, { ...PLACE, sequence: 1 })]);
    expect([...editor.labels]).toEqual([...BLANK]);
  });

  it("names the stroke that cannot be done", async () => {
    const outside: Operation = { kind: "segment_wide", seed: 6, label: 1 };
    await expect(replayedLog(strip(), BLANK, log({ kind: "clear" }, outside))).rejects.toThrow(
      "stroke 1 of the log cannot be replayed",
    );
  });

  it("is refused on another mesh, and on other labels", async () => {
    await expect(replayedLog(strip(), BLANK, { ...log(), mesh_hash: "cup" })).rejects.toThrow("own mesh");
    await expect(
      replayedLog(
        strip(),
        BLANK.map(() => 1),
        log(),
      ),
    ).rejects.toThrow("own labels");
  });

  it("is refused where it is none", () => {
    const document = { format: "something", v: 1 };
    expect(() => readLog(document)).toThrow("no stroke log");
    expect(() => readLog({ v: 1 })).toThrow("must have format");
  });
});

describe("shares of parts", () => {
  it("count faces and area, of parts that are there", () => {
    const shares = partShares(strip(), Uint16Array.of(0, 0, 0, 2, 2, 2));
    expect([...shares.keys()]).toEqual([0, 2]);
    expect(shares.get(2)).toEqual({ nFaces: 3, area: 0.5 });
  });
});
