import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useMemo, useState } from "react";
import { useLocation } from "wouter";
import { partsQuery } from "../../api/queries";
import { RoomHeading } from "../../app/RoomHeading";
import { Button, useToast } from "../../components";
import { whole } from "../../components/numbers";
import { workAddress } from "../workbench/workAddress";
import { MAX_OPEN } from "./actions/limits";
import { SelectionBar } from "./actions/SelectionBar";
import type { TileLook } from "./grid/ShapeTile";
import { changeWords } from "./live/listChange";
import { useLiveRows } from "./live/useLiveRows";
import type { ShapeRow } from "./rows/shapeRows";
import { listKey, ordersQuery } from "./rows/tableQueries";
import { useListReader } from "./rows/useListReader";
import { useShapeRows } from "./rows/useShapeRows";
import { ShapeList, useWindow } from "./ShapeList";
import { SidePanel } from "./SidePanel";
import { useSelection } from "./selection/useSelection";
import styles from "./TableRoom.module.css";
import { FilterChips } from "./toolbar/FilterChips";
import { TableToolbar } from "./toolbar/TableToolbar";
import { TrainingLine } from "./toolbar/TrainingLine";
import { listName } from "./view/leftPlaces";
import { NO_FILTERS } from "./view/tableView";
import { useTableView } from "./view/useTableView";

/** Every shape of a collection: what is labelled, what to label next, and what to do with many at once. */
export function TableRoom({ collectionId }: { collectionId: number }) {
  const state = useTableView();
  const { view } = state;
  const [generation, setGeneration] = useState(0);
  const { filters, order, descending } = view;
  const list = useMemo(
    () => ({ collectionId, filters, order, descending, generation }),
    [collectionId, filters, order, descending, generation],
  );
  const [window, onWindow] = useWindow();
  const rows = useShapeRows(list, window.first, window.last);
  const change = useLiveRows(list);
  const selection = useSelection(list, useListReader(list));
  const look = useTileLook(collectionId, view);
  const open = useOpen(collectionId);
  const client = useQueryClient();
  const showNew = () => {
    client.removeQueries({ queryKey: listKey(list) });
    client.invalidateQueries({ queryKey: ["counts", collectionId] });
    setGeneration((held) => held + 1);
  };
  const { none, refresh } = selection;
  useEffect(() => {
    const shown: ShapeRow[] = [];
    for (let place = window.first; place <= window.last; place++) {
      const row = rows.rowAt(place);
      if (row) shown.push(row);
    }
    refresh(shown); // the same selection, unless one of its shapes has changed
  });
  const onActed = (shapeIds: readonly number[]) => {
    selection.setDone(shapeIds);
    if (filters.state === null) return;
    none();
    showNew(); // what is in another state now leaves a list of those in one, so that the next ones can be chosen
  };

  return (
    <div className={styles.room}>
      <RoomHeading title="Table" isUnseen />
      <div className={styles.main}>
        <TableToolbar collectionId={collectionId} state={state} nShapes={rows.nShapes} />
        <div className={styles.filterBar}>
          <FilterChips collectionId={collectionId} filters={view.filters} onFilter={state.filter} />
          <TrainingLine collectionId={collectionId} />
        </div>
        <section className={styles.list} aria-label="List of shapes">
          {change && (
            <div className={styles.reordered} role="status">
              <span>{changeWords(change)}</span>
              <Button size="small" variant="primary" onClick={showNew}>
                Show
              </Button>
            </div>
          )}
          <ShapeList
            key={listName(list)}
            {...{ list, rows, look, selection, onWindow }}
            onOpen={open}
            onClearFilters={() => state.filter(NO_FILTERS)}
          />
          <SelectionBar {...{ collectionId, selection, onActed }} onOpen={open} />
        </section>
      </div>
      <SidePanel {...{ collectionId, list, state, selection }} />
    </div>
  );
}

function useTileLook(
  collectionId: number,
  { shown, size, order }: ReturnType<typeof useTableView>["view"],
): TileLook {
  const parts = useQuery(partsQuery(collectionId)).data;
  const orders = useQuery(ordersQuery(collectionId)).data?.items;
  const partsVersion = parts?.parts.map((part) => part.colour.slice(1)).join("") ?? "";
  const isScore = order !== null && order !== "name";
  const scoreName = isScore ? (orders?.find((each) => each.name === order)?.label ?? order) : null;
  return useMemo(
    () => ({ shown, size, scoreName, partsVersion: digest(partsVersion) }),
    [shown, size, scoreName, partsVersion],
  );
}

/** A short name of the colours, so that pictures are drawn anew when any changes. */
function digest(text: string): string {
  let sum = 0;
  for (const letter of text) sum = (Math.imul(sum, 31) + letter.charCodeAt(0)) >>> 0;
  return sum.toString(36);
}

function useOpen(collectionId: number): (rows: readonly ShapeRow[]) => void {
  const [, navigate] = useLocation();
  const showToast = useToast();
  return useCallback(
    (rows) => {
      const ids = rows.slice(0, MAX_OPEN).map((row) => row.id);
      if (rows.length > MAX_OPEN) {
        const message = `The workbench takes ${MAX_OPEN} shapes at a time: the first ${MAX_OPEN} of ${whole(rows.length)} are open`;
        showToast({ message });
      }
      navigate(workAddress(collectionId, ids));
    },
    [collectionId, navigate, showToast],
  );
}
