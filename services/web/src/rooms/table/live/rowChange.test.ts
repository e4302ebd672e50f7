import { describe, expect, it } from "vitest";
import type { EventKind, ServiceEvent } from "../../../api/events";
import { rowChangeOf } from "./rowChange";

const event = (kind: EventKind, payload: Record<string, unknown>): ServiceEvent => ({
  kind,
  at: "2026-01-01T00:00:00Z",
  collectionId: 1,
  payload,
});

describe("rowChangeOf", () => {
  it("a confirmed shape is known to be so at once", () => {
    expect(rowChangeOf(event("shape", { shape_id: 4, state: "confirmed", revision_id: 9 }))).toEqual({
      shapeId: 4,
      known: { state: "confirmed", revision_id: 9, has_confirmed: true },
    });
  });

  it("a claim concerns one shape, of which the rest is read", () => {
    expect(rowChangeOf(event("queue", { shape_id: 4, person_id: 2, what: "claimed" }))).toEqual({
      shapeId: 4,
      known: {},
    });
  });

  it.each([
    event("queue", { re_ranked: 40 }),
    event("training", { model_version: 4 }),
    event("job", { job_id: 1, job_kind: "evaluate", state: "done" }),
    event("shape", { what: "parts changed", schema_version: 2 }),
  ])("a new model, new ranks, other parts and a finished job concern all rows: $kind", (each) => {
    expect(rowChangeOf(each)).toBe("all");
  });

  it("a stage that goes on concerns the rows in sight", () => {
    expect(rowChangeOf(event("stage", { stage: "describe", done: 3, failed: 0 }))).toBe("in sight");
  });

  it.each([
    event("job", { job_id: 1, state: "running", done: 3 }),
    event("people", { person_id: 2, what: "confirmed" }),
    event("training", { job_id: 3, state: "queued", n_confirmed: 10 }),
    event("queue", { what: "assigned", person_id: 2 }),
  ])("others change no row: $kind", (each) => {
    expect(rowChangeOf(each)).toBeNull();
  });

  it("leaves out states that this page does not know", () => {
    expect(rowChangeOf(event("shape", { shape_id: 4, state: "frozen" }))).toEqual({ shapeId: 4, known: {} });
  });
});
