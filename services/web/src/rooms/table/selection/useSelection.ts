/** The selection of the table, and what pointer and keyboard do to it. */
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { useToast } from "../../../components";
import type { ShapeRow } from "../rows/shapeRows";
import type { RowList } from "../rows/tableQueries";
import type { ListReader } from "../rows/useListReader";
import { leftPlace } from "../view/leftPlaces";
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

const NONE_LEFT = "All of these were acted on already. To act on some again, select them one by one.";

export interface SelectionState {
  readonly selection: Selection;
  only(row: ShapeRow, place: number): void;
  toggle(row: ShapeRow, place: number): void;
  /** From where a range begins to here; instead of what is chosen, or besides it. */
  range(place: number, isAdding: boolean): void;
  /** All of the list; of one of shapes in a state, those that are still in it and were not acted on. */
  all(nShapes: number): void;
  move(place: number): void;
  none(): void;
  /** Rows from elsewhere, as from the map; `nMore`: others that were meant, too. */
  take(rows: Promise<readonly ShapeRow[]>, isAdding: boolean, nMore: number): void;
  refresh(rows: Iterable<ShapeRow>): void;
  /** These were acted on: `all` has had them. */
  setDone(shapeIds: readonly number[]): void;
}

export function useSelection(list: RowList, reader: ListReader): SelectionState {
  const [selection, setSelection] = useState<Selection>(NOTHING);
  const showToast = useToast();
  const done = useRef(new Set<number>());
  const nChanges = useRef(0);
  const { change, read } = useMemo(() => {
    const change = (next: (held: Selection) => Selection) => {
      nChanges.current += 1;
      setSelection(next);
    };
    /** Rows may have to be asked for; by then somebody may have chosen something else, and that stays. */
    const read = <T>(
      found: Promise<T>,
      next: (held: Selection, found: T) => Selection,
      tell: (found: T) => void = () => undefined,
    ) => {
      nChanges.current += 1;
      const asked = nChanges.current;
      const isWanted = () => nChanges.current === asked;
      found.then(
        (rows) => {
          if (!isWanted()) return;
          change((held) => next(held, rows));
          tell(rows);
        },
        (error: Error) => isWanted() && showToast({ message: error.message, tone: "bad" }),
      );
    };
    return { change, read };
  }, [showToast]);

  const { collectionId, filters } = list;
  const { state } = filters;
  // Another list begins with nothing chosen; the same shapes in another order are chosen still.
  // biome-ignore lint/correctness/useExhaustiveDependencies: these tell lists of other shapes apart
  useEffect(() => {
    done.current.clear();
    change(chooseNone);
  }, [collectionId, filters, change]);
  // Places are those of a list: a range does not begin in the one before.
  useEffect(() => change((held) => moveTo(held, leftPlace(list).cursor)), [list, change]);

  const { anchor } = selection;
  const actions = useMemo(
    () => ({
      only: (row: ShapeRow, place: number) => change((held) => chooseOnly(held, row, place)),
      toggle: (row: ShapeRow, place: number) => change((held) => toggle(held, row, place)),
      range: (place: number, isAdding: boolean) => {
        const { first, count, nMore } = span(anchor, place);
        // The keyboard is there at once; the rows between may have to be read first.
        change((held) => ({ ...held, cursor: place }));
        read(reader.range(first, count), (held, rows) =>
          chooseRange(held, rows, { cursor: held.cursor, isAdding, nMore }),
        );
      },
      all: (nShapes: number) => {
        const isLeft = (row: ShapeRow) =>
          state === null || (row.state === state && !done.current.has(row.id));
        read(
          reader.firstOf(MAX_CHOSEN, isLeft),
          (held, { rows, nPassed }) => chooseAll(held, rows, nShapes - nPassed),
          ({ rows, nPassed }) => rows.length === 0 && nPassed > 0 && showToast({ message: NONE_LEFT }),
        );
      },
      move: (place: number) => change((held) => moveTo(held, place)),
      none: () => change(chooseNone),
      take: (rows: Promise<readonly ShapeRow[]>, isAdding: boolean, nMore: number) =>
        read(rows, (held, found) => chooseRange(held, found, { cursor: held.cursor, isAdding, nMore })),
    }),
    [anchor, state, reader, change, read, showToast],
  );
  const refresh = useCallback(
    (rows: Iterable<ShapeRow>) => setSelection((held) => refreshed(held, rows)),
    [],
  );
  const setDone = useCallback((shapeIds: readonly number[]) => {
    for (const id of shapeIds) done.current.add(id);
  }, []);
  return useMemo(() => ({ selection, ...actions, refresh, setDone }), [selection, actions, refresh, setDone]);
}
