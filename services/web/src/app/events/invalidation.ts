/** Which answers of the service no longer hold after an event. The rows of the table and the map see to their own. */
import type { Query } from "@tanstack/react-query";
import type { EventKind, ServiceEvent } from "../../api/events";
import type { About } from "../../api/queryKeys";

const STALE_AFTER: Readonly<Record<EventKind, readonly About[]>> = {
  queue: ["leases", "skips", "ops"],
  training: ["models", "orders", "rounds", "ops", "jobs"],
  stage: ["ops", "failures", "counts", "orders", "shape"],
  job: ["jobs", "ops", "failures"],
  people: ["ops people", "rounds"],
  shape: ["shape", "counts", "reviews", "accepts", "ops"],
};
/** Besides, once a job is over. */
const STALE_AFTER_JOB: readonly About[] = ["counts", "models", "orders", "shape"];

/** Whether an event only says how far a job is: they come often, and nobody needs each of them at once. */
export function isProgress({ kind, payload }: ServiceEvent): boolean {
  return kind === "job" && payload.state === "running";
}

/** Whether a query's answer is about what the event tells of. */
export function isStaleAfter(event: ServiceEvent, queryKey: Query["queryKey"]): boolean {
  const [about, id] = queryKey;
  if (!staleAfter(event).includes(about)) return false;
  if (about === "shape") return event.payload.shape_id === undefined || event.payload.shape_id === id;
  return event.collectionId === null || typeof id !== "number" || id === event.collectionId;
}

/** Rows that the table shows are kept true by itself, so that none of them moves under the pointer. */
export function isKeptInPlace({ queryKey, state }: Query): boolean {
  return queryKey[0] === "rows" && state.status === "success";
}

function staleAfter(event: ServiceEvent): readonly About[] {
  const { kind, payload } = event;
  const isOver = kind === "job" && ["done", "failed", "cancelled"].includes(String(payload.state));
  return isOver ? [...STALE_AFTER.job, ...STALE_AFTER_JOB] : STALE_AFTER[kind];
}
