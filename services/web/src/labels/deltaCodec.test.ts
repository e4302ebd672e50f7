import { deflateSync, inflateSync } from "node:zlib";
import { describe, expect, it } from "vitest";
import { deltaJson, makeDelta, readDelta } from "./deltaCodec";
import { facesOfRuns, runsOf, withRuns } from "./faceRuns";
import type { DeltaJson } from "./operations";

const BEFORE = Uint16Array.of(0, 0, 7, 7, 1, 1, 0);
const AFTER = Uint16Array.of(3, 3, 3, 7, 500, 500, 1);

async function json(): Promise<DeltaJson> {
  return deltaJson(await makeDelta("start_from", { revision: 4 }, BEFORE, AFTER));
}

function payload(...words: number[]): string {
  const [first = 0, count = 0, label = 0] = words;
  const bytes = Buffer.alloc(10);
  bytes.writeUInt32LE(first, 0);
  bytes.writeUInt32LE(count, 4);
  bytes.writeUInt16LE(label, 8);
  return deflateSync(bytes).toString("base64");
}

describe("a delta", () => {
  it("turns the labels before into those after", async () => {
    const { changed } = await readDelta(await json());
    expect(withRuns(BEFORE, changed)).toEqual(AFTER);
  });

  it("is laid out as docs/segmentation.md says", async () => {
    const { n_faces, n_runs, payload } = await json();
    const raw = inflateSync(Buffer.from(payload, "base64"));
    expect([n_faces, n_runs, raw.length]).toEqual([7, 3, 30]);
    const words = (at: number) => [0, 1, 2].map((run) => raw.readUInt32LE(at + 4 * run));
    expect([words(0), words(12)]).toEqual([
      [0, 4, 6],
      [3, 2, 1],
    ]);
    expect([24, 26, 28].map((at) => raw.readUInt16LE(at))).toEqual([3, 500, 1]);
  });

  it("keeps its checksum though the labels go on", async () => {
    const after = AFTER.slice();
    const making = makeDelta("patches", {}, BEFORE, after);
    after.fill(9);
    expect((await making).sha256).toBe((await json()).sha256);
  });

  it("without a difference has no runs", async () => {
    const delta = await makeDelta("patches", {}, BEFORE, BEFORE);
    expect([delta.n_runs, (await readDelta(deltaJson(delta))).changed.first.length]).toEqual([0, 0]);
  });

  it("is of one mesh", async () => {
    await expect(makeDelta("patches", {}, BEFORE, AFTER.subarray(1))).rejects.toThrow("of 7 and 6 faces");
  });

  it.each([
    ["base64", { payload: "?" }],
    ["zlib", { payload: btoa("nothing") }],
    ["hold 2 runs", { n_runs: 2 }],
    ["hold 4 runs", { n_runs: 4 }],
    ["must ascend", { n_runs: 1, payload: payload(0, 0, 1) }],
    ["within 7 faces", { n_runs: 1, payload: payload(6, 2, 1) }],
  ])("is refused where damaged: %s", async (message, damage) => {
    await expect(readDelta({ ...(await json()), ...damage })).rejects.toThrow(message);
  });

  it("that would fill the memory is not read to its end", async () => {
    const bomb = deflateSync(Buffer.alloc(50_000_000)).toString("base64");
    await expect(readDelta({ ...(await json()), payload: bomb })).rejects.toThrow("must hold 3 runs");
  });
});

describe("runs", () => {
  it("are of faces in any order, each once", () => {
    expect(runsOf([7, 3, 4, 3, 5])).toEqual([
      [3, 3],
      [7, 1],
    ]);
  });

  it("say their faces", () => {
    expect([...facesOfRuns(runsOf([9, 1, 2]))]).toEqual([1, 2, 9]);
  });
});
