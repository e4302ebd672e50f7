import { describe, expect, it } from "vitest";
import type { Schemas } from "../../../api/client";
import { failedTraining, failureWords, trainingJob, trainingShare, trainingWords } from "./trainingWords";

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

describe("failedTraining", () => {
  const failed = aJob({ id: 4, state: "failed", finished_at: "2026-01-02T00:00:00Z", message: "too few" });
  const scoring = aJob({ id: 5, kind: "evaluate", state: "failed", finished_at: "2026-01-03T00:00:00Z" });
  const model = (trained_at: string) => ({ id: 1, version: 3, n_shapes: 2, recipe: {}, trained_at });

  it("is the newest that failed, if no model has come since", () => {
    expect(failedTraining([scoring, failed], undefined)).toBe(failed);
    expect(failedTraining([failed], model("2026-01-01T00:00:00Z"))).toBe(failed);
    expect(failedTraining([failed], model("2026-01-02T00:00:01Z"))).toBeNull();
    expect(failedTraining([scoring], undefined)).toBeNull();
  });

  it("says why", () => {
    expect(failureWords(failed, null)).toBe("Model 1 could not be trained: too few");
    expect(failureWords(aJob({}), 3)).toBe("Model 4 could not be trained");
  });
});

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
