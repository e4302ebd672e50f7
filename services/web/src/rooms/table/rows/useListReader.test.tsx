// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { cleanup, renderHook } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { NO_FILTERS } from "../view/tableView";
import { PAGE_ROWS, type ShapeRow } from "./shapeRows";
import { pageQuery, type RowList } from "./tableQueries";
import { aPage, aRow } from "./testing";
import { useListReader } from "./useListReader";

const served = vi.hoisted(() => vi.fn());
vi.mock("../../../api/client", () => ({ api: { GET: served }, body: (answer: unknown) => answer }));

const LIST: RowList = { collectionId: 1, filters: NO_FILTERS, order: null, descending: false, generation: 0 };
const N = 2 * PAGE_ROWS;

/** A page of shapes whose ids are their places, from `offset` on. */
const page = (number: number, offset = 0, given: Partial<ShapeRow> = {}) =>
  aPage(
    Array.from({ length: PAGE_ROWS }, (_, i) => aRow({ id: number * PAGE_ROWS + i + offset, ...given })),
    N,
  );

function reading() {
  const client = new QueryClient();
  const { result } = renderHook(() => useListReader(LIST), {
    wrapper: ({ children }) => <QueryClientProvider client={client}>{children}</QueryClientProvider>,
  });
  return { client, reader: result.current };
}

beforeEach(() => {
  served.mockReset();
  served.mockImplementation(async (_path, { params }) =>
    params.query.first_rank >= N ? aPage([], N) : page(params.query.first_rank / PAGE_ROWS),
  );
});
afterEach(cleanup);

it("keeps the rows that are held, and asks for the others only", async () => {
  const { client, reader } = reading();
  client.setQueryData(pageQuery(LIST, 0).queryKey, page(0, 1_000)); // since then the service has another order
  const rows = await reader.range(PAGE_ROWS - 1, 2);
  expect(rows.map((row) => row.id)).toEqual([1_000 + PAGE_ROWS - 1, PAGE_ROWS]);
  expect(served).toHaveBeenCalledTimes(1);
  expect(served.mock.calls[0]?.[1].params.query.first_rank).toBe(PAGE_ROWS);
});

it("goes on past rows that are not wanted until there are enough", async () => {
  const { client, reader } = reading();
  client.setQueryData(pageQuery(LIST, 0).queryKey, page(0, 0, { state: "confirmed" }));
  const { rows, nPassed } = await reader.firstOf(2, (row) => row.state === "ready");
  expect(rows.map((row) => row.id)).toEqual([PAGE_ROWS, PAGE_ROWS + 1]);
  expect(nPassed).toBe(PAGE_ROWS);
});

it("ends with the list where there are not enough", async () => {
  const { rows, nPassed } = await reading().reader.firstOf(500, (row) => row.id % 2 === 0);
  expect(rows).toHaveLength(N / 2);
  expect(nPassed).toBe(N / 2);
});
