import { describe, expect, it } from "vitest";
import type { Schemas } from "../../../api/client";
import { trainingJob, trainingShare, trainingWords } from "./trainingWords";

type Job = Schemas["JobOut"];

function aJob(given: Partial<Job>): Job {
  return {
    id: 1,
    collection_id: 1,
    kind: "train",
    state: "running",
    parameters: {},
    attempts: 1,
    progress: { done: 0, failed: 0, total: null, message: "" },
    cancel_requested: false,
    created_at: "2026-01-01T00:00:00Z",
    started_at: null,
    heartbeat_at: null,
    finished_at: null,
    message: "",
    result: null,
    ...given,
  };
}

const progress = (done: number, total: number | null, failed = 0) => ({ done, failed, total, message: "" });

describe("trainingJob", () => {
  it("is what runs before what waits, and training before scoring", () => {
    const waits = aJob({ id: 1, state: "pending" });
    const scores = aJob({ id: 2, kind: "evaluate" });
    expect(trainingJob([waits, scores])?.id).toBe(2);
    expect(trainingJob([scores, aJob({ id: 3 })])?.id).toBe(3);
    expect(trainingJob([waits])?.id).toBe(1);
  });

  it("is nothing where no model is at work", () => {
    expect(trainingJob([aJob({ kind: "preprocess" }), aJob({ state: "done" })])).toBeNull();
  });
});

describe("trainingWords", () => {
  it.each([
    [aJob({ progress: progress(62, 100) }), 3, "Model 4 is being trained: 62 %"],
    [aJob({}), null, "Model 1 is being trained"],
    [aJob({ state: "pending" }), 3, "Model 4 waits to be trained"],
    [aJob({ kind: "evaluate", progress: progress(1, 3) }), 4, "Model 4 is scoring shapes: 33 %"],
    [aJob({ kind: "evaluate", state: "pending" }), 4, "Model 4 waits to score shapes"],
    [aJob({ kind: "refine" }), 4, "Model 4 is refining its predictions"],
  ])("%#", (job, version, words) => {
    expect(trainingWords(job, version)).toBe(words);
  });
});

describe("trainingShare", () => {
  it("counts what failed as done with, and is unknown without a total", () => {
    expect(trainingShare(aJob({ progress: progress(3, 8, 1) }))).toBe(0.5);
    expect(trainingShare(aJob({ progress: progress(3, null) }))).toBeNull();
    expect(trainingShare(aJob({ progress: progress(0, 0) }))).toBeNull();
  });
});
