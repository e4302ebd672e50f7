/** The points of a collection's map, kept true by events. */
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useMemo, useRef } from "react";
import type { ServiceEvent } from "../api/events";
import { useServiceEvents } from "../app/events/useServiceEvents";
import { mapChangeOf } from "./mapChange";
import { type PointState, withStates } from "./mapPoints";
import { embeddingQuery, mapQuery, readStates } from "./mapQueries";

/** Events come in bursts: the shapes of one are asked about together. */
const GATHER_MS = 600;
/** More are read with all others. */
const MOST_ASKED = 100;

export function useMapPoints(collectionId: number) {
  const client = useQueryClient();
  const embedding = useQuery(embeddingQuery(collectionId));
  const options = mapQuery(collectionId, embedding.data ?? "");
  const map = useQuery({ ...options, enabled: embedding.data !== undefined });
  const mapKey = useMemo(() => ["map", collectionId] as const, [collectionId]);
  const unknown = useRef(new Set<number>());
  const timer = useRef<number | undefined>(undefined);

  useEffect(
    () => () => {
      window.clearTimeout(timer.current);
      timer.current = undefined;
      unknown.current.clear();
      // nobody keeps the points true from now on: they are shown at once, and read again, when they are next looked at
      void client.invalidateQueries({ queryKey: mapKey, refetchType: "none" });
    },
    [client, mapKey],
  );
  const readAgain = () => void client.invalidateQueries({ queryKey: mapKey });
  const patch = (states: ReadonlyMap<number, PointState>) => {
    client.setQueryData(options.queryKey, (points) => points && withStates(points, states));
  };
  const ask = () => {
    timer.current = undefined;
    const ids = [...unknown.current];
    unknown.current.clear();
    if (ids.length > MOST_ASKED) readAgain();
    else void readStates(collectionId, ids).then(patch, readAgain);
  };
  const onEvent = (event: ServiceEvent) => {
    const change = mapChangeOf(event);
    if (change?.what === "drawn") void client.invalidateQueries(embeddingQuery(collectionId));
    else if (change?.what === "states") readAgain();
    else if (change?.state) patch(new Map([[change.shapeId, change.state]]));
    else if (change) {
      unknown.current.add(change.shapeId);
      timer.current ??= window.setTimeout(ask, GATHER_MS);
    }
  };
  useServiceEvents(collectionId, onEvent, () => {
    void client.invalidateQueries(embeddingQuery(collectionId));
    readAgain();
  });
  return {
    points: map.data,
    error: map.data === undefined ? (embedding.error ?? map.error) : null,
    refetch: () => void (embedding.data === undefined ? embedding.refetch() : map.refetch()),
  };
}
