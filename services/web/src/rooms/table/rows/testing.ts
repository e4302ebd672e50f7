/** Rows for tests. */
import type { RowPage, ShapeRow } from "./shapeRows";

export function aRow(given: Partial<ShapeRow> = {}): ShapeRow {
  return {
    id: 1,
    source_key: "chairs/a.off",
    state: "ready",
    mesh_hash: "0123456789abcdef",
    n_faces: 1_000,
    revision_id: null,
    author_id: null,
    author_name: null,
    has_confirmed: false,
    predicted_version: null,
    refined_version: null,
    cluster: null,
    failed_stage: null,
    score: null,
    model_version: null,
    rank: null,
    held_by: [],
    ...given,
  };
}

export function aPage(items: readonly ShapeRow[], nShapes = items.length): RowPage {
  return { n_shapes: nShapes, built_at: null, items: [...items] };
}
