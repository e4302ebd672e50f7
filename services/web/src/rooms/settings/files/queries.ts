import { queryOptions } from "@tanstack/react-query";
import { api, body } from "../../../api/client";

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
