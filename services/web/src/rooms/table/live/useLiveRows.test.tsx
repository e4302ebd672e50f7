// @vitest-environment jsdom
import { QueryClient, QueryClientProvider, QueryObserver } from "@tanstack/react-query";
import { act, cleanup, renderHook } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { EventKind } from "../../../api/events";
import { EventHub } from "../../../app/events/EventHub";
import { ServiceEventsContext } from "../../../app/events/useServiceEvents";
import type { RowPage } from "../rows/shapeRows";
import { fetchNamedRows, fetchRows, pageQuery, type RowList } from "../rows/tableQueries";
import { aPage, aRow } from "../rows/testing";
import { NO_FILTERS } from "../view/tableView";
import { useLiveRows } from "./useLiveRows";

vi.mock("../rows/tableQueries", async (original) => ({
  ...(await original<typeof import("../rows/tableQueries")>()),
  fetchRows: vi.fn(),
  fetchNamedRows: vi.fn(),
}));

const LIST: RowList = {
  collectionId: 1,
  filters: NO_FILTERS,
  order: null,
  descending: false,
  generation: 0,
};
const served = vi.mocked(fetchRows);

function shown() {
  const client = new QueryClient();
  client.setQueryData(pageQuery(LIST, 0).queryKey, aPage([aRow({ id: 1 }), aRow({ id: 2 })]));
  const hub = new EventHub();
  const wrapper = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={client}>
      <ServiceEventsContext value={{ hub, connection: "connected" }}>{children}</ServiceEventsContext>
    </QueryClientProvider>
  );
  const { result, unmount } = renderHook(() => useLiveRows(LIST), { wrapper });
  const publish = (kind: EventKind, payload: Record<string, unknown>) =>
    act(() => hub.publish({ kind, at: "", collectionId: 1, payload }));
  const rows = (page = 0) => client.getQueryData<RowPage>(pageQuery(LIST, page).queryKey)?.items ?? [];
  return { result, unmount, publish, rows, hub, client };
}

const pass = (ms = 1_000) => act(() => vi.advanceTimersByTimeAsync(ms));

beforeEach(() => {
  vi.useFakeTimers();
  served.mockReset();
});
afterEach(() => {
  cleanup();
  vi.useRealTimers();
});

describe("useLiveRows", () => {
  it("shows a confirmed shape at once, and what else is known of it a moment later, in its place", async () => {
    const row = aRow({ id: 2, state: "confirmed", has_confirmed: true, revision_id: 5, author_name: "ann" });
    served.mockResolvedValue(aPage([aRow({ id: 1 }), row]));
    const { result, publish, rows } = shown();
    publish("shape", { shape_id: 2, state: "confirmed", revision_id: 5 });
    expect(rows()[1]).toMatchObject({ id: 2, state: "confirmed", author_name: null });
    await pass();
    expect(rows()[1]).toMatchObject({ id: 2, author_name: "ann" });
    expect(result.current).toBeNull();
  });

  it("does not ask the service about shapes that are not shown", async () => {
    const { publish } = shown();
    publish("shape", { shape_id: 99, state: "confirmed", revision_id: 5 });
    await pass();
    expect(served).not.toHaveBeenCalled();
  });

  it("reads a page once for a burst of events", async () => {
    served.mockResolvedValue(aPage([aRow({ id: 1 }), aRow({ id: 2 })]));
    const { publish } = shown();
    for (let i = 0; i < 10; i++) publish("queue", { shape_id: 1 + (i % 2), what: "claimed" });
    await pass();
    expect(served).toHaveBeenCalledTimes(1);
  });

  it("says that the order has changed, and leaves shapes where they are", async () => {
    served.mockResolvedValue(aPage([aRow({ id: 2, score: 0.9 }), aRow({ id: 1, score: 0.1 })]));
    const { result, publish, rows } = shown();
    publish("queue", { re_ranked: 2 });
    await pass();
    expect(result.current).toMatchObject({ nMore: 0 });
    expect(rows().map((row) => [row.id, row.score])).toEqual([
      [1, 0.1],
      [2, 0.9],
    ]);
  });

  it("shows how a shape stands that no longer belongs to the list, and leaves it where it is", async () => {
    served.mockResolvedValue(aPage([aRow({ id: 1 })]));
    vi.mocked(fetchNamedRows).mockResolvedValue([aRow({ id: 2, state: "confirmed" })]);
    const { result, publish, rows } = shown();
    publish("shape", { shape_id: 2, what: "labelled" });
    await pass();
    expect(fetchNamedRows).toHaveBeenCalledWith(LIST, [2]);
    expect(rows().map((row) => [row.id, row.state])).toEqual([
      [1, "ready"],
      [2, "confirmed"],
    ]);
    expect(result.current).toMatchObject({ nMore: -1 });
  });

  it("keeps what is shown where the service cannot be reached", async () => {
    served.mockRejectedValue(new Error("down"));
    const { publish, rows, hub } = shown();
    publish("training", { model_version: 2 });
    act(() => hub.publishMissed());
    await pass();
    expect(rows().map((row) => row.id)).toEqual([1, 2]);
  });

  it("reads pages again that could not be read, and the others at once", async () => {
    const { publish, rows, client } = shown();
    client.setQueryData(pageQuery(LIST, 1).queryKey, aPage([aRow({ id: 3 })]));
    served.mockRejectedValueOnce(new Error("down")).mockResolvedValue(aPage([aRow({ id: 3, score: 0.5 })]));
    publish("training", { model_version: 2 });
    await pass();
    expect(rows(1)[0]?.score).toBe(0.5);
    expect(rows()[0]?.score).toBeNull();
    served.mockResolvedValue(aPage([aRow({ id: 1, score: 0.7 }), aRow({ id: 2 })]));
    await pass(2_000);
    expect(rows()[0]?.score).toBe(0.7);
    expect(served).toHaveBeenCalledTimes(3);
  });

  it("reads what is in sight while a stage goes on, once for many that it tells of", async () => {
    const { publish, rows, client } = shown();
    const outOfSight = pageQuery(LIST, 1).queryKey;
    client.setQueryData(outOfSight, aPage([aRow({ id: 3 })]));
    const observer = new QueryObserver(client, pageQuery(LIST, 0));
    const stop = observer.subscribe(() => undefined);
    served.mockResolvedValue(aPage([aRow({ id: 1, predicted_version: 1 }), aRow({ id: 2 })]));
    publish("stage", { stage: "evaluate", done: 1 });
    publish("stage", { stage: "evaluate", done: 2 });
    await pass();
    expect(served).not.toHaveBeenCalled();
    await pass(6_000);
    expect(rows()[0]?.predicted_version).toBe(1);
    expect(served).toHaveBeenCalledTimes(1);
    expect(client.getQueryState(outOfSight)?.isInvalidated).toBe(true);
    stop();
  });

  it("shows the shapes that come to a list that was empty", async () => {
    const { result, publish, rows, client } = shown();
    client.setQueryData(pageQuery(LIST, 0).queryKey, aPage([]));
    served.mockResolvedValue(aPage([aRow({ id: 1 })]));
    publish("job", { state: "done" });
    await pass();
    expect(rows().map((row) => row.id)).toEqual([1]);
    expect(result.current).toBeNull();
  });

  it("stops with the room", async () => {
    const { publish, unmount } = shown();
    publish("queue", { re_ranked: 2 });
    unmount();
    await pass();
    expect(served).not.toHaveBeenCalled();
  });
});
