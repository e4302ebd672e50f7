import { describe, expect, it } from "vitest";
import type { EventKind } from "../api/events";
import { mapChangeOf } from "./mapChange";
import { POINT_STATES, withStates } from "./mapPoints";
import { somePoints } from "./testing";

const points = somePoints([0, 1, 2], [0, 0, 0]);
const stateOf = (held: typeof points, place: number) => POINT_STATES[held.state[place] as number];

describe("withStates", () => {
  it("changes the states of the shapes that are named, and leaves what was given as it is", () => {
    const changed = withStates(points, new Map([[2, "confirmed"]]));
    expect([0, 1, 2].map((place) => stateOf(changed, place))).toEqual(["new", "confirmed", "new"]);
    expect(stateOf(points, 1)).toBe("new");
    expect(changed.x).toBe(points.x);
  });

  it("is the same object where nothing changes, so that nothing is drawn", () => {
    expect(
      withStates(
        points,
        new Map([
          [2, "new"],
          [99, "confirmed"],
        ]),
      ),
    ).toBe(points);
  });
});

describe("mapChangeOf", () => {
  const change = (kind: EventKind, payload: Record<string, unknown>) =>
    mapChangeOf({ kind, at: "", collectionId: 1, payload });

  it("a shape stands elsewhere, where if the event says it", () => {
    expect(change("shape", { shape_id: 4, state: "confirmed" })).toEqual({
      what: "shape",
      shapeId: 4,
      state: "confirmed",
    });
    expect(change("shape", { shape_id: 4, what: "labelled" })).toMatchObject({
      shapeId: 4,
      state: undefined,
    });
  });

  it("parts that changed may leave any shape elsewhere", () => {
    expect(change("shape", { what: "parts changed" })).toEqual({ what: "states" });
  });

  it.each(["preprocess", "select"])("the map is another once %s is done", (kind) => {
    expect(change("job", { job_kind: kind, state: "done" })).toEqual({ what: "drawn" });
  });

  it("other jobs, and those that go on, change nothing", () => {
    expect(change("job", { job_kind: "preprocess", state: "running" })).toBeNull();
    expect(change("job", { job_kind: "train", state: "done" })).toBeNull();
    expect(change("queue", { shape_id: 4, what: "claimed" })).toBeNull();
  });
});
