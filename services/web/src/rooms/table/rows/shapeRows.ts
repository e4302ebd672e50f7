/** Rows of the table in pages: which pages a window needs, and pages that are read anew without moving a row. */
import type { Schemas } from "../../../api/client";
import type { Shown } from "../view/tableView";

export type ShapeRow = Schemas["ShapeRow"];
export type RowPage = Schemas["RankedShapes"];
export type ShownLabels = Exclude<Shown, "best">;

/** Shapes asked for at once. */
export const PAGE_ROWS = 120;

/** Numbers of the pages that hold the places `first` to `last`. */
export function pagesOf(first: number, last: number): number[] {
  if (last < first) return [];
  const begin = Math.floor(first / PAGE_ROWS);
  return Array.from({ length: Math.floor(last / PAGE_ROWS) - begin + 1 }, (_, i) => begin + i);
}

/** Whether a page that was read anew has its shapes at other places. */
export function isReordered(held: RowPage, fresh: RowPage): boolean {
  return (
    held.n_shapes !== fresh.n_shapes ||
    held.items.length !== fresh.items.length ||
    held.items.some((row, place) => row.id !== fresh.items[place]?.id)
  );
}

/**
 * The page as it is shown, with what is known anew of its shapes: none of them moves under the pointer. Where nothing is
 * shown nothing can move, so that a list that was empty fills.
 */
export function renewed(held: RowPage, fresh: RowPage): RowPage {
  if (held.n_shapes === 0) return fresh;
  const now = new Map(fresh.items.map((row) => [row.id, row]));
  const items = held.items.map((row) => {
    const known = now.get(row.id);
    return known === undefined || isSame(row, known) ? row : { ...known, rank: row.rank };
  });
  return { ...held, items };
}

/** The page with something changed of one shape; the same page if the shape is not on it. */
export function patched(page: RowPage, shapeId: number, change: Partial<ShapeRow>): RowPage {
  if (page.items.every((row) => row.id !== shapeId)) return page;
  return { ...page, items: page.items.map((row) => (row.id === shapeId ? { ...row, ...change } : row)) };
}

/** The labels that a tile shows; null where the shape has none of those asked for, and it is drawn grey. */
export function shownOf(row: ShapeRow, shown: Shown): ShownLabels | null {
  if ((shown === "best" || shown === "confirmed") && row.has_confirmed) return "confirmed";
  if ((shown === "best" || shown === "refined") && row.refined_version !== null) return "refined";
  if ((shown === "best" || shown === "predicted") && row.predicted_version !== null) return "predicted";
  return null;
}

/** The model that made the labels shown; null where a person did, or there are none. */
export function shownVersion(row: ShapeRow, shown: Shown): number | null {
  const labels = shownOf(row, shown);
  if (labels === "refined") return row.refined_version;
  return labels === "predicted" ? row.predicted_version : null;
}

/** Address of the tile's picture. It changes when the labels do, so that the browser draws it anew. */
export function pictureOf(row: ShapeRow, shown: Shown, partsVersion: string): string | null {
  if (row.mesh_hash === null) return null;
  const labels = shownOf(row, shown);
  if (labels === null) return `/api/v1/shapes/${row.id}/thumbnail?v=${row.mesh_hash.slice(0, 8)}`;
  const made = labels === "confirmed" ? row.revision_id : shownVersion(row, shown);
  return `/api/v1/shapes/${row.id}/thumbnail?segmentation=${labels}&v=${row.mesh_hash.slice(0, 8)}-${made}-${partsVersion}`;
}

/** The last segment of a source key, and the folders before it. */
export function nameOf(sourceKey: string): { folder: string; name: string } {
  const cut = sourceKey.lastIndexOf("/") + 1;
  return { folder: sourceKey.slice(0, cut), name: sourceKey.slice(cut) };
}

function isSame(one: ShapeRow, other: ShapeRow): boolean {
  return JSON.stringify({ ...one, rank: 0 }) === JSON.stringify({ ...other, rank: 0 });
}
