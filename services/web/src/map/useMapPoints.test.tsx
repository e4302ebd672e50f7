// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, renderHook, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { api } from "../api/client";
import type { EventKind } from "../api/events";
import { EventHub } from "../app/events/EventHub";
import { ServiceEventsContext } from "../app/events/useServiceEvents";
import { POINT_STATES } from "./mapPoints";
import { useMapPoints } from "./useMapPoints";

/** What the service has: ids, and where they stand. */
let served = { embedding: "e1", ids: [1, 2], states: ["ready", "ready"] };
const asked = vi.spyOn(api, "GET");

function answer(path: string, limit: number) {
  if (path.endsWith("/rows")) {
    return { items: served.ids.map((id, i) => ({ id, state: served.states[i] })) };
  }
  const ids = served.ids.slice(0, limit);
  return {
    embedding: served.embedding,
    n_shapes: served.ids.length,
    shape_ids: ids,
    x: ids,
    y: ids,
    clusters: ids.map(() => 0),
    states: served.states.slice(0, limit),
    first_shape_ids: [],
    next: null,
  };
}

function shown() {
  const client = new QueryClient({ defaultOptions: { queries: { retry: false } } });
  const hub = new EventHub();
  const wrapper = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={client}>
      <ServiceEventsContext value={{ hub, connection: "connected" }}>{children}</ServiceEventsContext>
    </QueryClientProvider>
  );
  const look = () => renderHook(() => useMapPoints(1), { wrapper });
  const publish = (kind: EventKind, payload: Record<string, unknown>) =>
    act(() => hub.publish({ kind, at: "", collectionId: 1, payload }));
  return { look, publish, hub };
}

const nReads = () =>
  (asked.mock.calls as unknown as [string, { params: { query: { limit?: number } } }][]).filter(
    ([path, { params }]) => path.endsWith("/embedding") && params.query.limit !== 1,
  ).length;
const statesOf = (look: ReturnType<ReturnType<typeof shown>["look"]>) =>
  [...(look.result.current.points?.state ?? [])].map((state) => POINT_STATES[state]);

beforeEach(() => {
  served = { embedding: "e1", ids: [1, 2], states: ["ready", "ready"] };
  asked.mockReset();
  asked.mockImplementation(((path: string, options: { params: { query: { limit: number } } }) =>
    Promise.resolve({ data: answer(path, options.params.query.limit) })) as never);
});
afterEach(cleanup);

describe("useMapPoints", () => {
  it("shows at once where a shape stands that somebody confirmed, without reading points again", async () => {
    const { look, publish } = shown();
    const map = look();
    await waitFor(() => expect(statesOf(map)).toEqual(["ready", "ready"]));
    publish("shape", { shape_id: 2, state: "confirmed" });
    await waitFor(() => expect(statesOf(map)).toEqual(["ready", "confirmed"]));
    expect(nReads()).toBe(1);
  });

  it("asks where shapes stand that an event does not tell of", async () => {
    const { look, publish } = shown();
    const map = look();
    await waitFor(() => expect(statesOf(map)).toHaveLength(2));
    served.states = ["review", "ready"];
    publish("shape", { shape_id: 1, what: "labelled" });
    await waitFor(() => expect(statesOf(map)).toEqual(["review", "ready"]), { timeout: 3_000 });
    expect(nReads()).toBe(1);
  });

  it("reads all points once there is another embedding, and shows the old ones meanwhile", async () => {
    const { look, publish } = shown();
    const map = look();
    await waitFor(() => expect(statesOf(map)).toHaveLength(2));
    served = { embedding: "e2", ids: [1, 2, 3], states: ["ready", "ready", "ready"] };
    publish("job", { job_kind: "preprocess", state: "done" });
    expect(map.result.current.points).toBeDefined();
    await waitFor(() => expect(statesOf(map)).toHaveLength(3));
    expect(nReads()).toBe(2);
  });

  it("reads nothing but the embedding's name where a job has placed nothing", async () => {
    const { look, publish } = shown();
    const map = look();
    await waitFor(() => expect(statesOf(map)).toHaveLength(2));
    const before = asked.mock.calls.length;
    publish("job", { job_kind: "preprocess", state: "done" });
    await waitFor(() => expect(asked.mock.calls.length).toBe(before + 1));
    expect(nReads()).toBe(1);
  });

  it("shows what was read before at once when it is looked at again, and reads what it has missed", async () => {
    const { look } = shown();
    const map = look();
    await waitFor(() => expect(statesOf(map)).toHaveLength(2));
    map.unmount();
    served.states = ["ready", "confirmed"];
    const again = look();
    expect(statesOf(again)).toEqual(["ready", "ready"]);
    await waitFor(() => expect(statesOf(again)).toEqual(["ready", "confirmed"]));
  });
});
