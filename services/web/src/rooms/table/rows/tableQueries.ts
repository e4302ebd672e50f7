/** What the table asks the service. */
import { queryOptions } from "@tanstack/react-query";
import { api, body } from "../../../api/client";
import type { ShapeFilters } from "../view/tableView";
import { PAGE_ROWS, type RowPage, type ShapeRow } from "./shapeRows";

/** A list of shapes: filters and an order, as they were at a generation. "Show the new order" begins the next one. */
export interface RowList {
  readonly collectionId: number;
  readonly filters: ShapeFilters;
  readonly order: string | null;
  readonly descending: boolean;
  readonly generation: number;
}

/** Pages out of sight are kept for so long, then dropped from memory. */
const DROPPED_AFTER_MS = 20_000;

export function filterQuery(filters: ShapeFilters) {
  const { name, state, part, cluster, author, failed } = filters;
  return {
    ...(name === null ? {} : { name }),
    ...(state === null ? {} : { state }),
    ...(part === null ? {} : { part }),
    ...(cluster === null ? {} : { cluster }),
    ...(author === null ? {} : { author }),
    ...(failed === null ? {} : { failure: failed }),
  };
}

/** Shapes of a list from a place on. */
export function fetchRows(
  list: RowList,
  first: number,
  limit: number,
  signal?: AbortSignal,
): Promise<RowPage> {
  const query = {
    ...filterQuery(list.filters),
    order: list.order ?? "none",
    direction: list.descending ? ("desc" as const) : ("asc" as const),
    first_rank: first,
    limit,
  };
  const params = { path: { collection_id: list.collectionId }, query };
  return body(
    api.GET("/api/v1/collections/{collection_id}/shapes/ranked", { params, ...(signal ? { signal } : {}) }),
  );
}

/** Rows of these shapes, with their score of the list's order. */
export async function fetchNamedRows(
  list: RowList,
  shapeIds: readonly number[],
): Promise<readonly ShapeRow[]> {
  const params = {
    path: { collection_id: list.collectionId },
    query: { id: [...shapeIds], order: list.order ?? "none" },
  };
  return (await body(api.GET("/api/v1/collections/{collection_id}/shapes/rows", { params }))).items;
}

/** Everything that hangs on a list, for changing or dropping it at once. */
export const listKey = (list: RowList) => ["rows", ...restOf(list)] as const;

const restOf = ({ collectionId, filters, order, descending, generation }: RowList) =>
  [collectionId, filters, order, descending, generation] as const;

/** A page. What events change is changed in place, so it never grows stale by itself. */
export const pageQuery = (list: RowList, page: number) =>
  queryOptions({
    queryKey: ["rows", ...restOf(list), page],
    queryFn: ({ signal }) => fetchRows(list, page * PAGE_ROWS, PAGE_ROWS, signal),
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: DROPPED_AFTER_MS,
    refetchOnWindowFocus: false,
    refetchOnReconnect: false,
  });

/** How many shapes meet the filters. */
export const countQuery = (collectionId: number, filters: ShapeFilters) =>
  queryOptions({
    queryKey: ["counts", collectionId, filters],
    queryFn: async ({ signal }) => {
      const params = { path: { collection_id: collectionId }, query: filterQuery(filters) };
      const found = await body(
        api.GET("/api/v1/collections/{collection_id}/shapes/count", { params, signal }),
      );
      return found.n_shapes;
    },
  });

export const ordersQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["orders", collectionId],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/orders", {
          params: { path: { collection_id: collectionId } },
        }),
      ),
  });

export const modelsQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["models", collectionId],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/models", {
          params: { path: { collection_id: collectionId } },
        }),
      ),
  });

export const peopleQuery = queryOptions({
  queryKey: ["people"],
  queryFn: () => body(api.GET("/api/v1/people")),
});

/** Jobs that wait for a worker. */
export const waitingJobsQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["jobs", collectionId, "pending"],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/jobs", {
          params: { path: { collection_id: collectionId }, query: { state: "pending", limit: 20 } },
        }),
      ),
  });

/** Jobs that ended without what they were for, newest first. */
export const failedJobsQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["jobs", collectionId, "failed"],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/jobs", {
          params: { path: { collection_id: collectionId }, query: { state: "failed", limit: 20 } },
        }),
      ),
  });

export function startTraining(collectionId: number) {
  const params = { path: { collection_id: collectionId } };
  return body(
    api.POST("/api/v1/collections/{collection_id}/jobs", { params, body: { kind: "train", parameters: {} } }),
  );
}
