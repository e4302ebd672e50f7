/** Keeps rows on screen true by events, in place: no shape moves under the pointer until somebody asks for it. */
import { type QueryClient, useQueryClient } from "@tanstack/react-query";
import { useEffect, useMemo, useRef, useState } from "react";
import type { ServiceEvent } from "../../../api/events";
import { useServiceEvents } from "../../../app/events/useServiceEvents";
import { isReordered, PAGE_ROWS, patched, type RowPage, renewed, type ShapeRow } from "../rows/shapeRows";
import { fetchNamedRows, fetchRows, listKey, pageQuery, type RowList } from "../rows/tableQueries";
import { type RowChange, rowChangeOf } from "./rowChange";

/** Events come in bursts; pages are read anew once for each. */
const GATHER_MS = 600;

/** Returns whether the service has the list in another order, or other shapes in it, than is shown. */
export function useLiveRows(list: RowList): boolean {
  const client = useQueryClient();
  const key = JSON.stringify(listKey(list));
  const [reordered, setReordered] = useState<string | null>(null);
  const renewal = useRef<Renewal | null>(null);
  useEffect(() => {
    const begun = new Renewal(client, list, () => setReordered(key));
    renewal.current = begun;
    return () => begun.stop();
  }, [client, list, key]);
  const handlers = useMemo(
    () => ({
      onEvent: (event: ServiceEvent) => {
        const change = rowChangeOf(event);
        if (change !== null) renewal.current?.take(change);
      },
      onMissed: () => renewal.current?.take("all"),
    }),
    [],
  );
  useServiceEvents(list.collectionId, handlers.onEvent, handlers.onMissed);
  return reordered === key;
}

/** Reads pages that are held anew, a moment after the first event that concerns them. */
class Renewal {
  private readonly pages = new Set<number>();
  private readonly shapeIds = new Set<number>();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private readonly stopping = new AbortController();

  constructor(
    private readonly client: QueryClient,
    private readonly list: RowList,
    private readonly onReordered: () => void,
  ) {}

  take(change: RowChange): void {
    for (const [page, rows] of this.held()) {
      if (change === "all") this.pages.add(page);
      else if (rows.items.some((row) => row.id === change.shapeId)) {
        this.client.setQueryData(this.keyOf(page), patched(rows, change.shapeId, change.known));
        this.pages.add(page);
        this.shapeIds.add(change.shapeId);
      }
    }
    if (this.pages.size > 0) this.timer ??= setTimeout(() => void this.read(), GATHER_MS);
  }

  stop(): void {
    clearTimeout(this.timer);
    this.stopping.abort();
  }

  private async read(): Promise<void> {
    const pages = [...this.pages];
    this.pages.clear();
    const changed = [...this.shapeIds];
    this.shapeIds.clear();
    this.timer = undefined;
    for (const page of pages) {
      const before = this.client.getQueryData<RowPage>(this.keyOf(page));
      if (before === undefined || this.stopping.signal.aborted) continue;
      try {
        const fresh = await fetchRows(this.list, page * PAGE_ROWS, PAGE_ROWS, this.stopping.signal);
        const held = this.client.getQueryData<RowPage>(this.keyOf(page)) ?? before;
        if (isReordered(held, fresh)) this.onReordered();
        const gone = await this.goneFrom(held, fresh, changed);
        this.client.setQueryData(
          this.keyOf(page),
          renewed(held, { ...fresh, items: [...fresh.items, ...gone] }),
        );
      } catch {
        return; // the service cannot be reached, which the bar shows; the next event tries again
      }
    }
  }

  /** Shapes that changed and no longer belong where they are shown, as in a list of those that wait. */
  private goneFrom(held: RowPage, fresh: RowPage, changed: readonly number[]): Promise<readonly ShapeRow[]> {
    const there = new Set(fresh.items.map((row) => row.id));
    const gone = held.items.filter((row) => changed.includes(row.id) && !there.has(row.id));
    const ids = gone.map((row) => row.id);
    return ids.length === 0 ? Promise.resolve([]) : fetchNamedRows(this.list, ids);
  }

  private held(): [number, RowPage][] {
    const found = this.client.getQueriesData<RowPage>({ queryKey: listKey(this.list) });
    return found.flatMap(([key, rows]) => (rows === undefined ? [] : [[key.at(-1) as number, rows]]));
  }

  private keyOf(page: number) {
    return pageQuery(this.list, page).queryKey;
  }
}
