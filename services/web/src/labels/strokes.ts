/** Strokes: operations with who did them, when, and on what, as they are sent, stored and served (version 1). */
import { deltaJson } from "./deltaCodec";
import type { Operation, OperationJson } from "./operations";

export const STROKE_VERSION = 1;

export interface StrokePlace {
  /** How many strokes of the log come before it. */
  readonly sequence: number;
  /** The label revision that the log starts from; null for all unlabelled. */
  readonly base_revision: number | null;
  readonly author_id: number;
}

interface StrokeEnvelope extends StrokePlace {
  readonly v: typeof STROKE_VERSION;
  /** A UUID made here: sending the stroke twice adds it once. */
  readonly id: string;
  /** ISO 8601, UTC. */
  readonly at: string;
}

export type StrokeJson = OperationJson & StrokeEnvelope;

/** A new stroke of an operation that was done, with an id of its own. */
export function newStroke(operation: Operation, place: StrokePlace, at: Date = new Date()): StrokeJson {
  return {
    v: STROKE_VERSION,
    ...operationJson(operation),
    id: newId(),
    sequence: place.sequence,
    base_revision: place.base_revision,
    author_id: place.author_id,
    at: at.toISOString(),
  };
}

/** The operation without what is only in hand. */
export function operationJson(operation: Operation): OperationJson {
  return operation.kind === "delta" ? deltaJson(operation) : operation;
}

/** A random UUID. `crypto.randomUUID` is missing where the page is not served from localhost or over https. */
export function newId(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  bytes[6] = ((bytes[6] as number) & 0x0f) | 0x40;
  bytes[8] = ((bytes[8] as number) & 0x3f) | 0x80;
  const hex = Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
  return [hex.slice(0, 8), hex.slice(8, 12), hex.slice(12, 16), hex.slice(16, 20), hex.slice(20)].join("-");
}
