import { describe, expect, it } from "vitest";
import type { ServiceEvent } from "../../../api/events";
import { endedFor, warningOf } from "./useDesk";

const told = (payload: ServiceEvent["payload"], kind: ServiceEvent["kind"] = "queue"): ServiceEvent => ({
  kind,
  at: "",
  collectionId: 1,
  payload,
});

describe("an event", () => {
  it.each(["cleared", "expired"])("tells that this person\u2019s shape was %s", (what) =>
    expect(endedFor(2, told({ shape_id: 7, person_id: 2, what }))).toBe(7),
  );
  it("tells nothing of what they did themselves", () =>
    expect(endedFor(2, told({ shape_id: 7, person_id: 2, what: "released" }))).toBeNull());
  it("tells nothing of others, whom it does not even name", () => {
    expect(endedFor(2, told({ shape_id: 7, person_id: 3, what: "cleared" }))).toBeNull();
    expect(endedFor(2, told({ shape_id: 7 }))).toBeNull();
  });
  it("tells nothing if it is about something else", () =>
    expect(endedFor(2, told({ shape_id: 7, person_id: 2, what: "cleared" }, "people"))).toBeNull());
});

describe("closing the page", () => {
  it.each([true, false])("is asked about only while the page alone has strokes (else: %s)", (isEmpty) => {
    const closing = new Event("beforeunload", { cancelable: true });
    warningOf({ isEmpty })(closing);
    expect(closing.defaultPrevented).toBe(!isEmpty);
  });
});
