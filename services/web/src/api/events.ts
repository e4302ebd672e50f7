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
  /** Whether the stream is there. It comes back by itself, and resumes from the last id. */
  onConnection(isConnected: boolean): void;
}

const REOPEN_MS = 4_000;
/** Browsers open few connections to one service: tabs that nobody looks at leave theirs to others. */
const HIDDEN_MS = 30_000;

/** Listens until the function that it returns is called. */
export function listen(listener: EventListener): () => void {
  const stream = new EventStream(listener);
  stream.connect();
  return () => stream.disconnect();
}

/**
 * One stream. Browsers resume one that breaks, but give up on one that was refused: that is opened anew. It rests while
 * the page has been out of sight for a while, and goes on from the last id once it is looked at again.
 */
class EventStream {
  private source: EventSource | undefined;
  private reopening: ReturnType<typeof setTimeout> | undefined;
  private resting: ReturnType<typeof setTimeout> | undefined;
  private lastId = "";

  constructor(private readonly listener: EventListener) {}

  connect(): void {
    document.addEventListener("visibilitychange", this.follow);
    this.open();
  }

  disconnect(): void {
    document.removeEventListener("visibilitychange", this.follow);
    clearTimeout(this.resting);
    this.close();
  }

  private readonly follow = () => {
    clearTimeout(this.resting);
    if (document.visibilityState === "hidden") this.resting = setTimeout(() => this.close(), HIDDEN_MS);
    else if (this.source === undefined) this.open();
  };

  private open(): void {
    const after = this.lastId === "" ? "" : `?after=${encodeURIComponent(this.lastId)}`;
    const source = new EventSource(`/api/v1/events${after}`, { withCredentials: true });
    this.source = source;
    for (const kind of EVENT_KINDS) source.addEventListener(kind, (message) => this.receive(kind, message));
    source.addEventListener("begin", (message) => this.begin(message));
    source.addEventListener("missed", (message) => {
      this.begin(message);
      this.listener.onMissed();
    });
    source.addEventListener("error", () => this.lose(source));
  }

  private close(): void {
    clearTimeout(this.reopening);
    this.source?.close();
    this.source = undefined;
  }

  private begin(message: MessageEvent<string>): void {
    this.lastId = message.lastEventId;
    this.listener.onConnection(true);
  }

  private receive(kind: EventKind, message: MessageEvent<string>): void {
    this.lastId = message.lastEventId;
    const { at, collection_id, payload } = JSON.parse(message.data);
    this.listener.onEvent({ kind, at, collectionId: collection_id, payload });
  }

  private lose(source: EventSource): void {
    this.listener.onConnection(false);
    if (source.readyState !== EventSource.CLOSED) return;
    clearTimeout(this.reopening);
    this.reopening = setTimeout(() => this.open(), REOPEN_MS);
  }
}
