// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
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
  const rows = () => client.getQueryData<RowPage>(pageQuery(LIST, 0).queryKey)?.items ?? [];
  return { result, unmount, publish, rows, hub };
}

const pass = () => act(() => vi.advanceTimersByTimeAsync(1_000));

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
    expect(result.current).toBe(false);
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
    expect(result.current).toBe(true);
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
    expect(result.current).toBe(true);
  });

  it("keeps what is shown where the service cannot be reached", async () => {
    served.mockRejectedValue(new Error("down"));
    const { publish, rows, hub } = shown();
    publish("training", { model_version: 2 });
    act(() => hub.publishMissed());
    await pass();
    expect(rows().map((row) => row.id)).toEqual([1, 2]);
  });

  it("stops with the room", async () => {
    const { publish, unmount } = shown();
    publish("queue", { re_ranked: 2 });
    unmount();
    await pass();
    expect(served).not.toHaveBeenCalled();
  });
});
