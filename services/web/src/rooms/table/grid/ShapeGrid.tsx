import { type KeyboardEvent, useEffect, useRef, useState } from "react";
import { Skeleton } from "../../../components";
import type { ShapeRow } from "../rows/shapeRows";
import type { RowList } from "../rows/tableQueries";
import type { SelectionState } from "../selection/useSelection";
import { leftPlace, rememberPlace } from "../view/leftPlaces";
import { GAP_PX, gridGeometry, placeAfter } from "./gridGeometry";
import styles from "./ShapeGrid.module.css";
import { ShapeTile, type TileLook, tileId } from "./ShapeTile";
import { useGridPointer } from "./useGridPointer";
import { useGridVirtualizer } from "./useGridVirtualizer";
import { useHeldPlace } from "./useHeldPlace";
import { useSelectAllKey } from "./useSelectAllKey";
import { useSize } from "./useSize";

export interface ShapeGridProps {
  readonly list: RowList;
  readonly nShapes: number;
  readonly look: TileLook;
  readonly selection: SelectionState;
  rowAt(place: number): ShapeRow | undefined;
  /** Places that are drawn, for their rows to be read. */
  onWindow(first: number, last: number): void;
  onOpen(rows: readonly ShapeRow[]): void;
}

/** Tiles of a list of any length, of which only those in view are drawn. */
export function ShapeGrid(props: ShapeGridProps) {
  const { list, nShapes, look, selection: chosen, rowAt, onWindow, onOpen } = props;
  const scroller = useRef<HTMLDivElement>(null);
  const { width, height } = useSize(scroller);
  const [isByKey, setByKey] = useState(false);
  const geometry = gridGeometry(width, look.size, nShapes);
  const { columns, tilePx, rowPx } = geometry;
  const grid = useGridVirtualizer(scroller, geometry, height);
  const first = (grid.rows[0]?.index ?? 0) * columns;
  const last = Math.min(nShapes, ((grid.rows.at(-1)?.index ?? 0) + 1) * columns) - 1;
  useEffect(() => onWindow(first, last), [first, last, onWindow]);

  const { selection } = chosen;
  const cursor = Math.min(selection.cursor, Math.max(0, nShapes - 1));
  const [began] = useState(() => leftPlace(list));
  const place = useHeldPlace(scroller, geometry, grid.ratio, width > 0, began.first);
  const leave = useRef(() => {});
  leave.current = () => rememberPlace(list, { first: place.current, cursor });
  useEffect(() => () => leave.current(), []);
  const withRow = (place: number, then: (row: ShapeRow) => void) => {
    const row = rowAt(place);
    if (row) then(row);
  };
  const pointer = useGridPointer(
    {
      only: (place) => withRow(place, (row) => chosen.only(row, place)),
      toggle: (place) => withRow(place, (row) => chosen.toggle(row, place)),
      range: chosen.range,
      open: (place) => withRow(place, (row) => onOpen([row])),
    },
    selection.chosen.size > 0,
  );

  useSelectAllKey(() => {
    chosen.all(nShapes);
    scroller.current?.focus({ preventScroll: true });
  });
  const onKeyDown = (event: KeyboardEvent) => {
    const isCtrl = event.ctrlKey || event.metaKey;
    const rowsInView = Math.max(1, Math.floor(height / rowPx));
    const next = placeAfter(event.key, cursor, { columns, nShapes, rowsInView, toEnd: isCtrl });
    if (next !== null && !event.altKey) {
      if (event.shiftKey) chosen.range(next, false);
      else chosen.move(next);
      grid.show(Math.floor(next / columns));
    } else if (event.key === " ") withRow(cursor, (row) => chosen.toggle(row, cursor));
    else if (event.key === "Escape" && selection.chosen.size > 0) chosen.none();
    else if (event.key === "Enter") {
      if (selection.chosen.size > 0) onOpen([...selection.chosen.values()]);
      else withRow(cursor, (row) => onOpen([row]));
    } else return;
    setByKey(true);
    event.preventDefault();
  };

  const start = grid.rows[0]?.start ?? 0;
  const isCursorDrawn = cursor >= first && cursor <= last;
  return (
    // biome-ignore lint/a11y/useSemanticElements: a table cannot be drawn in part
    <div
      ref={scroller}
      className={styles.grid}
      role="grid"
      aria-label="Shapes"
      aria-multiselectable="true"
      aria-rowcount={geometry.nRows}
      aria-colcount={columns}
      aria-activedescendant={isCursorDrawn ? tileId(cursor) : undefined}
      tabIndex={0}
      data-keyboard={isByKey || undefined}
      data-choosing={selection.chosen.size > 0 || undefined}
      onKeyDown={onKeyDown}
      onFocus={(event) => setByKey(event.currentTarget.matches(":focus-visible"))}
      onBlur={() => setByKey(false)}
      {...pointer}
      onPointerDown={(event) => {
        setByKey(false);
        pointer.onPointerDown(event);
      }}
    >
      <div className={styles.length} style={{ height: grid.elementPx }}>
        <div ref={grid.stage} className={styles.stage}>
          {width > 0 &&
            grid.rows.map((row) => (
              // biome-ignore lint/a11y/useFocusableInteractive: the grid keeps the focus
              // biome-ignore lint/a11y/useSemanticElements: a table cannot be drawn in part
              <div
                key={row.key}
                role="row"
                aria-rowindex={row.index + 1}
                className={styles.row}
                style={{
                  transform: `translateY(${row.start - start}px)`,
                  gridTemplateColumns: `repeat(${columns}, ${tilePx}px)`,
                  gap: GAP_PX,
                  paddingInline: GAP_PX,
                }}
              >
                {Array.from({ length: Math.min(columns, nShapes - row.index * columns) }, (_, column) => {
                  const place = row.index * columns + column;
                  const shape = rowAt(place);
                  return shape ? (
                    <ShapeTile
                      key={shape.id}
                      row={shape}
                      {...{ place, column, look }}
                      isChosen={selection.chosen.has(shape.id)}
                      isCursor={place === cursor}
                    />
                  ) : (
                    <Waiting key={`at ${place}`} place={place} column={column} />
                  );
                })}
              </div>
            ))}
        </div>
      </div>
    </div>
  );
}

function Waiting({ place, column }: { place: number; column: number }) {
  return (
    // biome-ignore lint/a11y/useFocusableInteractive: the grid keeps the focus
    // biome-ignore lint/a11y/useSemanticElements: a table cannot be drawn in part
    <div
      role="gridcell"
      id={tileId(place)}
      aria-colindex={column + 1}
      aria-label="Loading"
      className={styles.waiting}
    >
      <Skeleton className={styles.waitingPicture ?? ""} height="auto" />
      <Skeleton width="70%" height={12} />
    </div>
  );
}
