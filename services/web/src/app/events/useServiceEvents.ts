import { createContext, useContext, useEffect, useRef } from "react";
import type { ServiceEvent } from "../../api/events";
import type { EventHub } from "./EventHub";

/** "reconnecting": the network is there, the service is not (yet). */
export type ConnectionState = "connecting" | "connected" | "reconnecting" | "offline";

export interface ServiceEvents {
  hub: EventHub;
  connection: ConnectionState;
}

export const ServiceEventsContext = createContext<ServiceEvents | null>(null);

function useContextOfEvents(): ServiceEvents {
  const events = useContext(ServiceEventsContext);
  if (events === null) throw new Error("service events need a ServiceEventsProvider above");
  return events;
}

/** Whether the service can be heard. */
export function useConnection(): ConnectionState {
  return useContextOfEvents().connection;
}

/**
 * Calls `onEvent` for each event of a collection (null: of all), and `onMissed` when some were lost for good, so that
 * what they would have changed has to be read anew. Both may change between renders.
 */
export function useServiceEvents(
  collectionId: number | null,
  onEvent: (event: ServiceEvent) => void,
  onMissed: () => void = doNothing,
): void {
  const { hub } = useContextOfEvents();
  const latest = useRef({ onEvent, onMissed });
  useEffect(() => {
    latest.current = { onEvent, onMissed };
  });
  useEffect(
    () =>
      hub.subscribe({
        collectionId,
        onEvent: (event) => latest.current.onEvent(event),
        onMissed: () => latest.current.onMissed(),
      }),
    [hub, collectionId],
  );
}

function doNothing(): void {}
