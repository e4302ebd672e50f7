/** What an event says of rows of the table. */
import type { ServiceEvent } from "../../../api/events";
import type { ShapeRow } from "../rows/shapeRows";
import { STATES } from "../view/tableView";

/** One shape's row, with what of it is known already; or any row; or any in sight, as of many that change bit by bit. */
export type RowChange = { readonly shapeId: number; readonly known: Partial<ShapeRow> } | "all" | "in sight";

/** Null where no row changes. */
export function rowChangeOf(event: ServiceEvent): RowChange | null {
  const { kind, payload } = event;
  const shapeId = payload.shape_id;
  if (typeof shapeId === "number") return { shapeId, known: kind === "shape" ? knownOf(payload) : {} };
  if (kind === "shape") return "all"; // of many at once
  if (kind === "queue") return "re_ranked" in payload ? "all" : null;
  if (kind === "training") return "model_version" in payload ? "all" : null;
  if (kind === "stage") return "in sight"; // told every few seconds while shapes are prepared and scored
  // Jobs tell of every few shapes that they have done; all rows have changed for good once one is over.
  if (kind === "job") return payload.state === "done" ? "all" : null;
  return null;
}

function knownOf(payload: ServiceEvent["payload"]): Partial<ShapeRow> {
  const state = STATES.find((each) => each === payload.state);
  const revision = payload.revision_id;
  return {
    ...(state === undefined ? {} : { state }),
    ...(typeof revision === "number" ? { revision_id: revision, has_confirmed: true } : {}),
  };
}
