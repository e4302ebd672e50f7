import { QueryClient } from "@tanstack/react-query";
import { describe, expect, it } from "vitest";
import type { EventKind, ServiceEvent } from "../../api/events";
import { ABOUT, type About } from "../../api/queryKeys";
import { isKeptInPlace, isStaleAfter } from "./invalidation";
import { connectionState } from "./ServiceEventsProvider";

const event = (
  kind: EventKind,
  collectionId: number | null = 3,
  payload: ServiceEvent["payload"] = {},
): ServiceEvent => ({ kind, at: "", collectionId, payload });

/** Of all files of the page, what is written in them, but for tests. */
const SOURCES = Object.entries(
  import.meta.glob<string>("../../**/*.{ts,tsx}", { query: "?raw", import: "default", eager: true }),
).flatMap(([path, text]) => (path.includes(".test.") ? [] : [text]));
/** Not where answers are said to be stale: where they are asked for. */
const isAsked = (about: About) => {
  const key = new RegExp(`\\bqueryKey: \\["${about}".*\\],\\s+(queryFn|initialPageParam)`);
  return SOURCES.some((text) => key.test(text));
};

describe("what answers are about", () => {
  it.each(ABOUT)("is asked by some query: %s", (about) => expect(isAsked(about)).toBe(true));
});

describe("what an event makes stale", () => {
  it("answers about what it tells of", () =>
    expect(isStaleAfter(event("job"), ["jobs", 3, "running"])).toBe(true));
  it("not answers about other things", () => expect(isStaleAfter(event("job"), ["parts", 3])).toBe(false));
  it("not those of other collections", () => expect(isStaleAfter(event("job"), ["jobs", 4])).toBe(false));
  it("those of all collections", () => expect(isStaleAfter(event("job", null), ["jobs", 4])).toBe(true));
  it("not the table’s rows, which it keeps by itself", () =>
    expect(isStaleAfter(event("shape"), ["rows", 3])).toBe(false));
  it.each(["orders", "counts"] as const)("of a collection, its %s once shapes are scored", (about) => {
    expect(isStaleAfter(event("stage"), [about, 3, "more"])).toBe(true);
    expect(isStaleAfter(event("stage"), [about, 4, "more"])).toBe(false);
  });
  it("the shape itself, by its own id", () => {
    const labelled = event("shape", 3, { shape_id: 7 });
    expect(isStaleAfter(labelled, ["shape", 7, "card"])).toBe(true);
    expect(isStaleAfter(labelled, ["shape", 3, "card"])).toBe(false);
  });
  it("any shape, once one stage or job has been at all of them", () => {
    expect(isStaleAfter(event("stage"), ["shape", 7, "card"])).toBe(true);
    expect(isStaleAfter(event("job", 3, { state: "done" }), ["shape", 7, "card"])).toBe(true);
    expect(isStaleAfter(event("job", 3, { state: "running" }), ["shape", 7, "card"])).toBe(false);
  });
  it("how right bulk acceptance was, by what people label", () =>
    expect(isStaleAfter(event("shape"), ["accepts", 3])).toBe(true));
});

describe("rows that are shown", () => {
  const failing = () => Promise.reject(new Error("down"));
  it("are kept in place, unless they could not be read", async () => {
    const client = new QueryClient();
    client.setQueryData(["rows", 3, 0], "shown");
    await client.prefetchQuery({ queryKey: ["rows", 3, 1], queryFn: failing, retry: false });
    const kept = client.getQueryCache().getAll().map(isKeptInPlace);
    expect(kept).toEqual([true, false]);
  });
});

describe("the connection", () => {
  it("is offline without a network, whatever the stream says", () =>
    expect(connectionState(false, true)).toBe("offline"));
  it("is being made until the stream answers", () => expect(connectionState(true, null)).toBe("connecting"));
  it("is lost when the stream breaks", () => expect(connectionState(true, false)).toBe("reconnecting"));
  it("is there when the stream is", () => expect(connectionState(true, true)).toBe("connected"));
});
