import { useCallback, useState } from "react";
import { Button, Notice, Skeleton } from "../../components";
import { ShapeGrid } from "./grid/ShapeGrid";
import type { TileLook } from "./grid/ShapeTile";
import type { ShapeRow } from "./rows/shapeRows";
import type { RowList } from "./rows/tableQueries";
import type { ShapeRows } from "./rows/useShapeRows";
import type { SelectionState } from "./selection/useSelection";
import styles from "./TableRoom.module.css";
import { countFilters } from "./view/tableView";

export interface ShapeListProps {
  readonly list: RowList;
  readonly rows: ShapeRows;
  readonly look: TileLook;
  readonly selection: SelectionState;
  onWindow(first: number, last: number): void;
  onOpen(rows: readonly ShapeRow[]): void;
  onClearFilters(): void;
}

/** The grid, or why there is none. */
export function ShapeList(props: ShapeListProps) {
  const { list, rows, onClearFilters } = props;
  const nFilters = countFilters(list.filters);
  const isName = nFilters === 1 && list.filters.name !== null;
  if (rows.nShapes === null && rows.error !== null) {
    return (
      <Notice
        kind="error"
        isCentred
        title="The shapes could not be read"
        actions={<Button onClick={rows.retry}>Try again</Button>}
      >
        {rows.error.message}
      </Notice>
    );
  }
  if (rows.nShapes === null) return <Opening />;
  if (rows.nShapes === 0) {
    if (nFilters > 0) {
      return (
        <Notice
          kind="empty"
          title={isName ? `No name has “${list.filters.name}” in it` : "No shape meets these filters"}
          actions={<Button onClick={onClearFilters}>{isName ? "Clear the search" : "Clear filters"}</Button>}
        >
          {isName
            ? "Names are those of the files, with their folders."
            : "Take one of them away to see more."}
        </Notice>
      );
    }
    return <NothingYet order={list.order} />;
  }
  return (
    <>
      {rows.error !== null && (
        <Notice
          kind="error"
          title="Some shapes could not be read"
          actions={
            <Button size="small" onClick={rows.retry}>
              Try again
            </Button>
          }
        >
          {rows.error.message}
        </Notice>
      )}
      <ShapeGrid nShapes={rows.nShapes} {...props} rowAt={rows.rowAt} />
    </>
  );
}

function NothingYet({ order }: { order: string | null }) {
  if (order !== null && order !== "name") {
    return (
      <Notice kind="empty" title="No shape has this score yet">
        Shapes are scored once a model has been trained. Until then, order them by name.
      </Notice>
    );
  }
  return (
    <Notice kind="empty" title="No shapes yet">
      An operator can add files in the settings, or with <code>partwise ingest</code>.
    </Notice>
  );
}

/** Where tiles will be. */
function Opening() {
  return (
    <div className={styles.opening} aria-busy="true" role="status" aria-label="Reading shapes">
      {Array.from({ length: 24 }, (_, i) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: they are all the same
        <Skeleton key={i} height={190} />
      ))}
    </div>
  );
}

/** The places that are drawn, as the grid last told. */
export function useWindow(): [{ first: number; last: number }, (first: number, last: number) => void] {
  const [window, setWindow] = useState({ first: 0, last: 0 });
  const onWindow = useCallback(
    (first: number, last: number) =>
      setWindow((held) => (held.first === first && held.last === last ? held : { first, last })),
    [],
  );
  return [window, onWindow];
}
