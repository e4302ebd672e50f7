import { useMutation, useQueryClient } from "@tanstack/react-query";
import { api, body, type Schemas } from "../../../api/client";
import { useToast } from "../../../components";

export type IngestWish = Schemas["IngestRequest"];

/** Asks for a job that takes an upload, or what is below a prefix, into the collection. */
export function useIngest(collectionId: number) {
  const queries = useQueryClient();
  const toast = useToast();
  return useMutation({
    mutationFn: (wish: Partial<IngestWish>) =>
      body(
        api.POST("/api/v1/collections/{collection_id}/ingest", {
          params: { path: { collection_id: collectionId } },
          body: wish as IngestWish,
        }),
      ),
    onError: (error) => toast({ message: error.message, tone: "bad" }),
    onSettled: () =>
      Promise.all(
        (["jobs", "uploads"] as const).map((about) =>
          queries.invalidateQueries({ queryKey: [about, collectionId] }),
        ),
      ),
  });
}
