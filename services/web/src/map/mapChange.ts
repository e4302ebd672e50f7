/** What an event says of the map. */
import type { ServiceEvent } from "../api/events";
import { POINT_STATES, type PointState } from "./mapPoints";

/**
 * shape : one shape stands elsewhere, where if the event says it. states : any may. drawn : shapes may have been placed,
 * or all anew.
 */
export type MapChange =
  | { readonly what: "shape"; readonly shapeId: number; readonly state: PointState | undefined }
  | { readonly what: "states" }
  | { readonly what: "drawn" };

/** Jobs after which the service may have another embedding. */
const DRAWING: readonly unknown[] = ["preprocess", "select"];

/** Null where nothing changes. */
export function mapChangeOf({ kind, payload }: ServiceEvent): MapChange | null {
  if (kind === "job") {
    return payload.state === "done" && DRAWING.includes(payload.job_kind) ? { what: "drawn" } : null;
  }
  if (kind !== "shape") return null;
  if (typeof payload.shape_id !== "number") return { what: "states" };
  const state = POINT_STATES.find((each) => each === payload.state);
  return { what: "shape", shapeId: payload.shape_id, state };
}
