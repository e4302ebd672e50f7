/** What the room asks. Figures of pace are polled, as nobody announces them; all else follows events, too. */
import { infiniteQueryOptions, queryOptions } from "@tanstack/react-query";
import { api, body, type Schemas } from "../../api/client";

export type Ops = Schemas["OpsOut"];
export type Job = Schemas["JobOut"];
export type Failure = Schemas["FailureOut"];
export type FailureKind = Schemas["FailureKind"];
export type Lease = Schemas["LeaseOut"];

export const POLL_MS = 10_000;
const PAGE = 50;

const inCollection = (collectionId: number) => ({ collection_id: collectionId });

export const opsQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["ops", collectionId],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/ops", { params: { path: inCollection(collectionId) } }),
      ),
    refetchInterval: POLL_MS,
  });

export const jobsQuery = (collectionId: number) =>
  infiniteQueryOptions({
    queryKey: ["jobs", collectionId, "all"],
    queryFn: ({ pageParam }) =>
      body(
        api.GET("/api/v1/collections/{collection_id}/jobs", {
          params: {
            path: inCollection(collectionId),
            query: { limit: 20, ...(pageParam && { before: pageParam }) },
          },
        }),
      ),
    initialPageParam: 0,
    getNextPageParam: (page) => (page.next ? Number(page.next) : undefined),
  });

export interface FailureFilter {
  kind: FailureKind | null;
  stage: string | null;
}

export const failuresQuery = (collectionId: number, { kind, stage }: FailureFilter) =>
  infiniteQueryOptions({
    queryKey: ["failures", collectionId, kind, stage],
    queryFn: ({ pageParam }) =>
      body(
        api.GET("/api/v1/collections/{collection_id}/failures", {
          params: {
            path: inCollection(collectionId),
            query: { after: pageParam, limit: PAGE, ...(kind && { kind }), ...(stage && { stage }) },
          },
        }),
      ),
    initialPageParam: 0,
    getNextPageParam: (page) => (page.next ? Number(page.next) : undefined),
  });

export const leasesQuery = (collectionId: number) =>
  infiniteQueryOptions({
    queryKey: ["leases", collectionId, "all"],
    queryFn: ({ pageParam }) =>
      body(
        api.GET("/api/v1/collections/{collection_id}/leases", {
          params: { path: inCollection(collectionId), query: { after: pageParam, limit: PAGE } },
        }),
      ),
    initialPageParam: 0,
    getNextPageParam: (page) => (page.next ? Number(page.next) : undefined),
  });

/** Everybody, to tell ids by their names. */
export const peopleQuery = queryOptions({
  queryKey: ["people"],
  queryFn: () => body(api.GET("/api/v1/people")),
});

export const shapeQuery = (shapeId: number) =>
  queryOptions({
    queryKey: ["shape", shapeId, "card"],
    queryFn: () => body(api.GET("/api/v1/shapes/{shape_id}", { params: { path: { shape_id: shapeId } } })),
  });

export const roundsQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["rounds", collectionId],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/rounds", {
          params: { path: inCollection(collectionId) },
        }),
      ),
  });

export const peopleOpsQuery = (collectionId: number, days: number) =>
  queryOptions({
    queryKey: ["ops people", collectionId, days],
    queryFn: () =>
      body(api.GET("/api/v1/ops/people", { params: { query: { collection: collectionId, days } } })),
  });
