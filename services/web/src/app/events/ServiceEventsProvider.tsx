import { type QueryClient, useQueryClient } from "@tanstack/react-query";
import { type ReactNode, useEffect, useMemo, useState } from "react";
import { listen, type ServiceEvent } from "../../api/events";
import { meQuery } from "../../api/queries";
import { EventHub } from "./EventHub";
import { isKeptInPlace, isProgress, isStaleAfter } from "./invalidation";
import { Soon } from "./Soon";
import { type ConnectionState, ServiceEventsContext } from "./useServiceEvents";

const GATHER_MS = 400;
const PROGRESS_MS = 2_500;

/** Listens to the service for the whole page: one stream, whatever is shown. */
export function ServiceEventsProvider({ children }: { children: ReactNode }) {
  const queries = useQueryClient();
  const [hub] = useState(() => new EventHub());
  const [isConnected, setConnected] = useState<boolean | null>(null);
  const isOnline = useIsOnline();
  useEffect(() => follow(queries, hub, setConnected), [queries, hub]);
  const connection = connectionState(isOnline, isConnected);
  const events = useMemo(() => ({ hub, connection }), [hub, connection]);
  return <ServiceEventsContext value={events}>{children}</ServiceEventsContext>;
}

/** isConnected : null until the stream first answers. */
export function connectionState(isOnline: boolean, isConnected: boolean | null): ConnectionState {
  if (!isOnline) return "offline";
  if (isConnected === null) return "connecting";
  return isConnected ? "connected" : "reconnecting";
}

function follow(
  queries: QueryClient,
  hub: EventHub,
  setConnected: (isConnected: boolean) => void,
): () => void {
  let gathered: ServiceEvent[] = [];
  const soon = new Soon(() => {
    const events = gathered;
    gathered = [];
    void queries.invalidateQueries({
      predicate: (each) => events.some((event) => isStaleAfter(event, each.queryKey)),
    });
  });
  const stop = listen({
    onEvent(event) {
      hub.publish(event);
      gathered.push(event);
      soon.within(isProgress(event) ? PROGRESS_MS : GATHER_MS); // many come at once: ask anew once for all of them
    },
    onMissed() {
      hub.publishMissed();
      void queries.invalidateQueries({ predicate: (each) => !isKeptInPlace(each) });
    },
    onConnection(isConnected) {
      setConnected(isConnected);
      // A stream does not say why it ended. Asking who one is does: 401 opens the login.
      if (!isConnected) queries.fetchQuery({ ...meQuery, staleTime: 0, retry: false }).catch(() => undefined);
    },
  });
  return () => {
    soon.stop();
    stop();
  };
}

function useIsOnline(): boolean {
  const [isOnline, setOnline] = useState(navigator.onLine);
  useEffect(() => {
    const update = () => setOnline(navigator.onLine);
    window.addEventListener("online", update);
    window.addEventListener("offline", update);
    return () => {
      window.removeEventListener("online", update);
      window.removeEventListener("offline", update);
    };
  }, []);
  return isOnline;
}
