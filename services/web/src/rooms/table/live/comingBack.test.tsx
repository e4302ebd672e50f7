// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { cleanup, renderHook, waitFor } from "@testing-library/react";
import { type ReactNode, useMemo } from "react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { EventHub } from "../../../app/events/EventHub";
import { ServiceEventsContext } from "../../../app/events/useServiceEvents";
import type { ShapeRow } from "../rows/shapeRows";
import type { RowList } from "../rows/tableQueries";
import { aPage, aRow } from "../rows/testing";
import { useShapeRows } from "../rows/useShapeRows";
import { NO_FILTERS, type ShapeFilters } from "../view/tableView";
import { useLiveRows } from "./useLiveRows";

const served = vi.hoisted(() => vi.fn());
vi.mock("../../../api/client", () => ({ api: { GET: served }, body: (answer: unknown) => answer }));

const LIST: RowList = { collectionId: 1, filters: NO_FILTERS, order: null, descending: false, generation: 0 };

const FAILED: ShapeFilters = { ...NO_FILTERS, state: "failed" };

function useRoom({ filters }: { filters: ShapeFilters }) {
  const list = useMemo(() => ({ ...LIST, filters }), [filters]);
  useLiveRows(list);
  return useShapeRows(list, 0, 1);
}

/** The list as the room has it; it can be left and entered again. */
function room() {
  const client = new QueryClient();
  const hub = new EventHub();
  const wrapper = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={client}>
      <ServiceEventsContext value={{ hub, connection: "connected" }}>{children}</ServiceEventsContext>
    </QueryClientProvider>
  );
  return (filters = NO_FILTERS) => renderHook(useRoom, { wrapper, initialProps: { filters } });
}

const serve = (row: ShapeRow) => served.mockResolvedValue(aPage([row]));

beforeEach(() => served.mockReset());
afterEach(cleanup);

it("shows what a shape has become while the room was left for a moment", async () => {
  const enter = room();
  serve(aRow({ state: "ready" }));
  const before = enter();
  await waitFor(() => expect(before.result.current.rowAt(0)?.state).toBe("ready"));
  before.unmount();
  serve(aRow({ state: "confirmed" }));
  const after = enter();
  await waitFor(() => expect(after.result.current.rowAt(0)?.state).toBe("confirmed"));
});

it("shows what a shape has become while another list was shown for a moment", async () => {
  serve(aRow({ state: "ready" }));
  const { result, rerender } = room()();
  await waitFor(() => expect(result.current.rowAt(0)?.state).toBe("ready"));
  served.mockResolvedValue(aPage([]));
  rerender({ filters: FAILED });
  await waitFor(() => expect(result.current.nShapes).toBe(0));
  serve(aRow({ state: "confirmed" }));
  rerender({ filters: NO_FILTERS });
  await waitFor(() => expect(result.current.rowAt(0)?.state).toBe("confirmed"));
});
