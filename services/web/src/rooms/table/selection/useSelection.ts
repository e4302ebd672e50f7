/** The selection of the table, and what pointer and keyboard do to it. */
import { useCallback, useMemo, useState } from "react";
import { useToast } from "../../../components";
import type { ShapeRow } from "../rows/shapeRows";
import type { ReadRange } from "../rows/useRange";
import {
  chooseAll,
  chooseNone,
  chooseOnly,
  chooseRange,
  MAX_CHOSEN,
  moveTo,
  NOTHING,
  refreshed,
  type Selection,
  span,
  toggle,
} from "./selection";

export interface SelectionState {
  readonly selection: Selection;
  only(row: ShapeRow, place: number): void;
  toggle(row: ShapeRow, place: number): void;
  /** From where a range begins to here; instead of what is chosen, or besides it. */
  range(place: number, isAdding: boolean): void;
  all(nShapes: number): void;
  move(place: number): void;
  none(): void;
  /** These rows, from elsewhere, as from the map; `nMore`: others that were meant, too. */
  take(rows: readonly ShapeRow[], isAdding: boolean, nMore: number): void;
  refresh(rows: Iterable<ShapeRow>): void;
}

export function useSelection(readRange: ReadRange): SelectionState {
  const [selection, setSelection] = useState<Selection>(NOTHING);
  const showToast = useToast();
  const read = useCallback(
    (first: number, count: number, then: (rows: readonly ShapeRow[]) => void) => {
      readRange(first, count).then(then, (error: Error) =>
        showToast({ message: error.message, tone: "bad" }),
      );
    },
    [readRange, showToast],
  );
  const { anchor } = selection;
  const actions = useMemo(
    () => ({
      only: (row: ShapeRow, place: number) => setSelection((held) => chooseOnly(held, row, place)),
      toggle: (row: ShapeRow, place: number) => setSelection((held) => toggle(held, row, place)),
      range: (place: number, isAdding: boolean) => {
        const { first, count, nMore } = span(anchor, place);
        // The keyboard is there at once; the rows between may have to be read first.
        setSelection((held) => ({ ...held, cursor: place }));
        read(first, count, (rows) =>
          setSelection((held) => chooseRange(held, rows, { cursor: held.cursor, isAdding, nMore })),
        );
      },
      all: (nShapes: number) =>
        read(0, Math.min(nShapes, MAX_CHOSEN), (rows) =>
          setSelection((held) => chooseAll(held, rows, nShapes)),
        ),
      move: (place: number) => setSelection((held) => moveTo(held, place)),
      none: () => setSelection(chooseNone),
      take: (rows: readonly ShapeRow[], isAdding: boolean, nMore: number) =>
        setSelection((held) => chooseRange(held, rows, { cursor: held.cursor, isAdding, nMore })),
      refresh: (rows: Iterable<ShapeRow>) => setSelection((held) => refreshed(held, rows)),
    }),
    [anchor, read],
  );
  return useMemo(() => ({ selection, ...actions }), [selection, actions]);
}
