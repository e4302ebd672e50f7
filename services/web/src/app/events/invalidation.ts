/** Which answers of the service no longer hold after an event: the first words of their query keys. */
import type { EventKind, ServiceEvent } from "../../api/events";

const STALE_AFTER: Readonly<Record<EventKind, readonly string[]>> = {
  queue: ["queue", "leases", "ops"],
  training: ["models", "orders", "rounds", "ops", "jobs"],
  stage: ["ops", "failures", "counts"],
  job: ["jobs", "ops", "failures"],
  people: ["ops people", "rounds"],
  shape: ["shape", "counts", "reviews", "ops"],
};

/** Whether an event only says how far a job is: they come often, and nobody needs each of them at once. */
export function isProgress({ kind, payload }: ServiceEvent): boolean {
  return kind === "job" && payload.state === "running";
}

/** Whether a query's answer is about what the event tells of. Second in a key is the collection. */
export function isStaleAfter(event: ServiceEvent, queryKey: readonly unknown[]): boolean {
  const [about, collectionId] = queryKey;
  if (typeof about !== "string" || !STALE_AFTER[event.kind].includes(about)) return false;
  return (
    event.collectionId === null || typeof collectionId !== "number" || collectionId === event.collectionId
  );
}
