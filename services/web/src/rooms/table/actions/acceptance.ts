/** What bulk acceptance is about to do. */
import type { ShapeRow } from "../rows/shapeRows";

export type ModelLabels = "predicted" | "refined";

/** Shapes among those selected that have such labels of a model and none of a person. */
export function acceptable(rows: Iterable<ShapeRow>, labels: ModelLabels): ShapeRow[] {
  return [...rows].filter(
    (row) =>
      row.state === "ready" && (labels === "refined" ? row.refined_version : row.predicted_version) !== null,
  );
}

/** How many to have labelled unknowing, unless somebody says otherwise: one in twenty, at least one where there are two. */
export function suggestedRechecks(n: number): number {
  return n < 2 ? 0 : Math.max(1, Math.round(n / 20));
}

/** "Refined labels of models 3 and 4". */
export function versionsWords(rows: readonly ShapeRow[], labels: ModelLabels): string {
  const found = rows.map((row) => (labels === "refined" ? row.refined_version : row.predicted_version));
  const versions = [...new Set(found)].filter((each) => each !== null).sort((a, b) => a - b);
  if (versions.length === 0) return "";
  return `model${versions.length > 1 ? "s" : ""} ${new Intl.ListFormat("en").format(versions.map(String))}`;
}
