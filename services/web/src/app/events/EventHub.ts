import type { ServiceEvent } from "../../api/events";

export interface EventSubscriber {
  /** Null for all collections. */
  collectionId: number | null;
  onEvent: (event: ServiceEvent) => void;
  onMissed: () => void;
}

/** Hands each event of the one stream to whoever of the page listens. */
export class EventHub {
  private readonly subscribers = new Set<EventSubscriber>();

  subscribe(subscriber: EventSubscriber): () => void {
    this.subscribers.add(subscriber);
    return () => this.subscribers.delete(subscriber);
  }

  publish(event: ServiceEvent): void {
    for (const { collectionId, onEvent } of this.subscribers) {
      if (collectionId === null || event.collectionId === null || collectionId === event.collectionId)
        onEvent(event);
    }
  }

  publishMissed(): void {
    for (const { onMissed } of this.subscribers) onMissed();
  }
}
