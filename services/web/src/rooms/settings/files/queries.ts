import { queryOptions } from "@tanstack/react-query";
import { api, body, type Schemas } from "../../../api/client";

export const uploadsQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["uploads", collectionId],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/uploads", {
          params: { path: { collection_id: collectionId } },
        }),
      ),
  });

export const prefixesQuery = queryOptions({
  queryKey: ["ingest prefixes"],
  queryFn: () => body(api.GET("/api/v1/ingest-prefixes")),
});

export type Ingest = Schemas["JobOut"];

const LATEST = 200;

/** The latest jobs that take files in: which uploads somebody has asked for. */
export const ingestsQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["jobs", collectionId, "ingests"],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/jobs", {
          params: { path: { collection_id: collectionId }, query: { limit: LATEST } },
        }),
      ),
    select: (page) => page.items.filter((job) => job.kind === "ingest"),
  });
