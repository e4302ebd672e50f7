/** The view of the table, kept in the page's address: shareable, and the back button goes to the one before. */
import { useCallback, useMemo, useRef } from "react";
import { useLocation, useSearch } from "wouter";
import { type ShapeFilters, searchOf, type TableView, viewOf } from "./tableView";

export interface TableViewState {
  readonly view: TableView;
  /** `isPassing`: the change makes no place of its own to come back to, as while typing or dragging. */
  change(part: Partial<TableView>, isPassing?: boolean): void;
  filter(part: Partial<ShapeFilters>, isPassing?: boolean): void;
}

export function useTableView(): TableViewState {
  const search = useSearch();
  const [path, navigate] = useLocation();
  const read = useMemo(() => viewOf(search), [search]);
  // Filters are one object for as long as they are the same, whatever else of the view changes.
  const written = JSON.stringify(read.filters);
  // biome-ignore lint/correctness/useExhaustiveDependencies: `written` stands for the filters
  const filters = useMemo(() => read.filters, [written]);
  const view = useMemo(() => ({ ...read, filters }), [read, filters]);
  // What was navigated to last, so that two changes before the next rendering do not undo each other.
  const newest = useRef(view);
  newest.current = view;

  const change = useCallback(
    (part: Partial<TableView>, isPassing = false) => {
      newest.current = { ...newest.current, ...part };
      const next = searchOf(newest.current);
      navigate(next ? `${path}?${next}` : path, { replace: isPassing });
    },
    [navigate, path],
  );

  const filter = useCallback(
    (part: Partial<ShapeFilters>, isPassing = false) =>
      change({ filters: { ...newest.current.filters, ...part } }, isPassing),
    [change],
  );
  return { view, change, filter };
}
