/** Server-sent events: what changed elsewhere, so that pages show it without asking. */

export const EVENT_KINDS = ["queue", "training", "stage", "job", "people", "shape"] as const;
export type EventKind = (typeof EVENT_KINDS)[number];

export interface ServiceEvent {
  readonly kind: EventKind;
  readonly at: string;
  readonly collectionId: number | null;
  readonly payload: Readonly<Record<string, unknown>>;
}

export interface EventListener {
  onEvent(event: ServiceEvent): void;
  /** Events were missed for good: whatever is shown must be read anew. */
  onMissed(): void;
  /** Whether the stream is there. Browsers come back by themselves, and resume from the last id. */
  onConnection(isConnected: boolean): void;
}

/** Listens until the function that it returns is called. */
export function listen(listener: EventListener): () => void {
  const source = new EventSource("/api/v1/events", { withCredentials: true });
  for (const kind of EVENT_KINDS) {
    source.addEventListener(kind, (message: MessageEvent<string>) => {
      const { at, collection_id, payload } = JSON.parse(message.data);
      listener.onEvent({ kind, at, collectionId: collection_id, payload });
    });
  }
  source.addEventListener("begin", () => listener.onConnection(true));
  source.addEventListener("missed", () => {
    listener.onConnection(true);
    listener.onMissed();
  });
  source.addEventListener("error", () => listener.onConnection(false));
  return () => source.close();
}
