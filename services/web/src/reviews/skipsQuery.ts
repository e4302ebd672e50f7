/** What people gave back for good, and why, newest first. */
import { infiniteQueryOptions } from "@tanstack/react-query";
import { api, body, type Schemas } from "../api/client";

export type SkippedShape = Schemas["SkipOut"];

const PAGE = 50;
/** In place of an id that a page ended with. */
const NEWEST = 0;

export const skipsQuery = (collectionId: number) =>
  infiniteQueryOptions({
    queryKey: ["skips", collectionId],
    initialPageParam: NEWEST,
    queryFn: ({ pageParam, signal }) =>
      body(
        api.GET("/api/v1/collections/{collection_id}/skips", {
          params: {
            path: { collection_id: collectionId },
            query: { limit: PAGE, ...(pageParam === NEWEST ? {} : { before: pageParam }) },
          },
          signal,
        }),
      ),
    getNextPageParam: ({ next }) => (next == null ? undefined : Number(next)),
  });
