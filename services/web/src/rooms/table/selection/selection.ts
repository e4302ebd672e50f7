/** Which shapes are chosen, by id with the row they were chosen from, and where the keyboard is. */
import type { ShapeRow } from "../rows/shapeRows";

/** What one action of the service takes; no more can be chosen at a time. */
export const MAX_CHOSEN = 500;

export interface Selection {
  readonly chosen: ReadonlyMap<number, ShapeRow>;
  /** Place in the list where the keyboard is. */
  readonly cursor: number;
  /** Place where a range begins. */
  readonly anchor: number;
  /** Shapes that were asked for beyond what can be chosen at a time. */
  readonly nBeyond: number;
}

export const NOTHING: Selection = { chosen: new Map(), cursor: 0, anchor: 0, nBeyond: 0 };

export function chooseOnly(selection: Selection, row: ShapeRow, place: number): Selection {
  return { ...selection, chosen: new Map([[row.id, row]]), cursor: place, anchor: place, nBeyond: 0 };
}

export function toggle(selection: Selection, row: ShapeRow, place: number): Selection {
  const chosen = new Map(selection.chosen);
  if (!chosen.delete(row.id)) chosen.set(row.id, row);
  return { ...limited(chosen), cursor: place, anchor: place };
}

/** The rows instead of what was chosen, or besides it. `nMore`: rows that belong to the range but were not read. */
export function chooseRange(
  selection: Selection,
  rows: readonly ShapeRow[],
  { cursor, isAdding, nMore = 0 }: { cursor: number; isAdding: boolean; nMore?: number },
): Selection {
  const chosen = new Map(isAdding ? selection.chosen : []);
  for (const row of rows) chosen.set(row.id, row);
  const found = limited(chosen);
  return { ...found, nBeyond: found.nBeyond + nMore, cursor, anchor: selection.anchor };
}

export function chooseAll(selection: Selection, rows: readonly ShapeRow[], nShapes: number): Selection {
  const found = limited(new Map(rows.map((row) => [row.id, row])));
  return { ...selection, ...found, nBeyond: Math.max(0, nShapes - found.chosen.size) };
}

export function moveTo(selection: Selection, place: number): Selection {
  return { ...selection, cursor: place, anchor: place };
}

export function chooseNone(selection: Selection): Selection {
  return { ...selection, chosen: new Map(), nBeyond: 0 };
}

/** The selection with rows as they are now, so that what is told of them is true. */
export function refreshed(selection: Selection, rows: Iterable<ShapeRow>): Selection {
  let chosen: Map<number, ShapeRow> | null = null;
  for (const row of rows) {
    const held = selection.chosen.get(row.id);
    if (held === undefined || held === row) continue;
    chosen ??= new Map(selection.chosen);
    chosen.set(row.id, row);
  }
  return chosen === null ? selection : { ...selection, chosen };
}

/** Places from `from` to `to`, whichever comes first, from there on as many as can be chosen at a time. */
export function span(from: number, to: number): { first: number; count: number; nMore: number } {
  const length = Math.abs(to - from) + 1;
  const count = Math.min(length, MAX_CHOSEN);
  return { first: to >= from ? from : from - count + 1, count, nMore: length - count };
}

function limited(chosen: Map<number, ShapeRow>): Pick<Selection, "chosen" | "nBeyond"> {
  const nBeyond = Math.max(0, chosen.size - MAX_CHOSEN);
  return { chosen: nBeyond ? new Map([...chosen].slice(0, MAX_CHOSEN)) : chosen, nBeyond };
}
