import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { type Sample, withSample } from "./history";
import { opsQuery } from "./queries";

const NONE: readonly Sample[] = [];

/** The figures of now, and how they went since the page was opened, whichever room was shown since. */
export function useOpsHistory(collectionId: number) {
  const queries = useQueryClient();
  const ops = useQuery(opsQuery(collectionId));
  const history = useQuery<readonly Sample[]>({
    queryKey: ["ops history", collectionId],
    queryFn: () => NONE,
    initialData: NONE,
    enabled: false, // only ever added to, below
    gcTime: Number.POSITIVE_INFINITY,
  });
  const { data, dataUpdatedAt } = ops;
  useEffect(() => {
    if (data === undefined) return;
    queries.setQueryData<readonly Sample[]>(["ops history", collectionId], (before = NONE) =>
      withSample(before, data, dataUpdatedAt / 1000),
    );
  }, [queries, collectionId, data, dataUpdatedAt]);
  return { ops, history: history.data };
}
