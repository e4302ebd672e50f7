import { useMutation, useQueryClient } from "@tanstack/react-query";
import { api, body, type Schemas } from "../../../api/client";
import { useToast } from "../../../components";
import { count } from "../../../components/numbers";

type Wish = Partial<Schemas["Retry"]>;

/** Forgets failures, so that their shapes are tried again. */
export function useRetryFailures(collectionId: number, onRetried: () => void) {
  const queries = useQueryClient();
  const toast = useToast();
  return useMutation({
    mutationFn: (wish: Wish) =>
      body(
        api.POST("/api/v1/collections/{collection_id}/failures/retry", {
          params: { path: { collection_id: collectionId } },
          body: { text: "", ...wish },
        }),
      ),
    onSuccess: ({ n_retried }) => {
      onRetried();
      if (n_retried === 0) toast({ message: "Nothing was left to try again." });
      else
        toast({
          message: `${count(n_retried, "shape")} will be tried again as soon as a worker is free.`,
          tone: "good",
        });
    },
    onError: (error) => toast({ message: error.message, tone: "bad" }),
    onSettled: () =>
      Promise.all(
        (["failures", "ops", "jobs"] as const).map((about) =>
          queries.invalidateQueries({ queryKey: [about, collectionId] }),
        ),
      ),
  });
}
