import { describe, expect, it } from "vitest";
import type { EventKind, ServiceEvent } from "../../api/events";
import { isStaleAfter } from "./invalidation";
import { connectionState } from "./ServiceEventsProvider";

const event = (kind: EventKind, collectionId: number | null = 3): ServiceEvent => ({
  kind,
  at: "",
  collectionId,
  payload: {},
});

describe("what an event makes stale", () => {
  it("answers about what it tells of", () =>
    expect(isStaleAfter(event("job"), ["jobs", 3, "running"])).toBe(true));
  it("not answers about other things", () => expect(isStaleAfter(event("job"), ["parts", 3])).toBe(false));
  it("not those of other collections", () => expect(isStaleAfter(event("job"), ["jobs", 4])).toBe(false));
  it("those of all collections", () => expect(isStaleAfter(event("job", null), ["jobs", 4])).toBe(true));
  it("not the table’s rows, which it keeps by itself", () =>
    expect(isStaleAfter(event("shape"), ["shapes", 3])).toBe(false));
});

describe("the connection", () => {
  it("is offline without a network, whatever the stream says", () =>
    expect(connectionState(false, true)).toBe("offline"));
  it("is being made until the stream answers", () => expect(connectionState(true, null)).toBe("connecting"));
  it("is lost when the stream breaks", () => expect(connectionState(true, false)).toBe("reconnecting"));
  it("is there when the stream is", () => expect(connectionState(true, true)).toBe("connected"));
});
