/** How the map of a collection is looked at, for as long as the page is open. */
import { queryOptions, useQuery, useQueryClient } from "@tanstack/react-query";
import { useCallback } from "react";
import type { Camera } from "./camera";
import type { Colouring } from "./colours";
import type { Tool } from "./useMapGestures";

/** camera : null where all is shown. */
export interface MapLook {
  readonly tool: Tool;
  readonly colouring: Colouring;
  readonly camera: Camera | null;
}

const FIRST_LOOK: MapLook = { tool: "move", colouring: "cluster", camera: null };

const lookQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["map look", collectionId],
    queryFn: ({ client, queryKey }) => client.getQueryData<MapLook>(queryKey) ?? FIRST_LOOK,
    initialData: FIRST_LOOK,
    staleTime: "static",
    gcTime: Number.POSITIVE_INFINITY,
  });

export function useMapLook(collectionId: number): [MapLook, (change: Partial<MapLook>) => void] {
  const client = useQueryClient();
  const look = useQuery(lookQuery(collectionId)).data;
  const change = useCallback(
    (some: Partial<MapLook>) =>
      void client.setQueryData(lookQuery(collectionId).queryKey, (before = FIRST_LOOK) => ({
        ...before,
        ...some,
      })),
    [client, collectionId],
  );
  return [look, change];
}
