/** What several rooms ask the service, and how long the answers are good. */
import { QueryClient, queryOptions } from "@tanstack/react-query";
import { api, body } from "./client";
import { Problem } from "./problem";

const MAX_RETRIES = 3;

/** Answers are kept; events say which of them no longer hold. What the service refuses is not asked again. */
export function newQueryClient(): QueryClient {
  return new QueryClient({
    defaultOptions: {
      // A browser without a network still reaches a service of its own machine; and nothing waits without a word.
      mutations: { networkMode: "always" },
      queries: {
        networkMode: "always",
        refetchOnReconnect: true,
        staleTime: 30_000,
        retry: (failures, error) =>
          !(error instanceof Problem && error.status < 500) && failures < MAX_RETRIES,
      },
    },
  });
}

export const meQuery = queryOptions({
  queryKey: ["me"],
  queryFn: () => body(api.GET("/api/v1/me")),
  staleTime: Number.POSITIVE_INFINITY,
});

export const collectionsQuery = queryOptions({
  queryKey: ["collections"],
  queryFn: () => body(api.GET("/api/v1/collections")),
});

export const partsQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["parts", collectionId],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/parts", {
          params: { path: { collection_id: collectionId } },
        }),
      ),
  });

/** Jobs that workers are at now, newest first: what the bar shows and operators follow. */
export const runningJobsQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["jobs", collectionId, "running"],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/jobs", {
          params: { path: { collection_id: collectionId }, query: { state: "running", limit: 20 } },
        }),
      ),
  });
