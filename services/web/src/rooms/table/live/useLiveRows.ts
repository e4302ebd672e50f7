/** Keeps rows on screen true by events, in place: no shape moves under the pointer until somebody asks for it. */
import { type QueryClient, useQueryClient } from "@tanstack/react-query";
import { useEffect, useMemo, useRef, useState } from "react";
import type { ServiceEvent } from "../../../api/events";
import { Soon } from "../../../app/events/Soon";
import { useServiceEvents } from "../../../app/events/useServiceEvents";
import { isReordered, PAGE_ROWS, patched, type RowPage, renewed, type ShapeRow } from "../rows/shapeRows";
import { fetchNamedRows, fetchRows, listKey, pageQuery, type RowList } from "../rows/tableQueries";
import type { ListChange } from "./listChange";
import { type RowChange, rowChangeOf } from "./rowChange";

/** Events come in bursts; pages are read anew once for each. */
const GATHER_MS = 600;
/** Between readings while stages go on, which tell of it all the time. */
const STAGE_MS = 6_000;
/** Until pages that could not be read are asked for again; doubled from try to try. */
const RETRY_MS = 2_000;
const LONGEST_RETRY_MS = 60_000;

/** Returns how the service's list differs from the one that is shown; null while it has the same shapes in that order. */
export function useLiveRows(list: RowList): ListChange | null {
  const client = useQueryClient();
  const key = JSON.stringify(listKey(list));
  const [change, setChange] = useState<(ListChange & { key: string }) | null>(null);
  const renewal = useRef<Renewal | null>(null);
  useEffect(() => {
    setChange(null);
    const begun = new Renewal(client, list, (nMore) =>
      // Pages that were read at other times may know of more or fewer already, and of another order only.
      setChange((known) => (known !== null && nMore === 0 ? known : { key, nMore })),
    );
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
  return change?.key === key ? change : null;
}

/** Reads pages that are held anew, a moment after the first event that concerns them. */
class Renewal {
  private readonly pages = new Set<number>();
  private readonly shapeIds = new Set<number>();
  private readonly soon = new Soon(() => void this.read());
  private readonly stopping = new AbortController();
  private nFailures = 0;

  constructor(
    private readonly client: QueryClient,
    private readonly list: RowList,
    private readonly onReordered: (nMore: number) => void,
  ) {}

  take(change: RowChange): void {
    for (const [page, rows] of this.held()) {
      if (change === "all") this.pages.add(page);
      else if (change === "in sight") this.takeInSight(page);
      else if (rows.items.some((row) => row.id === change.shapeId)) {
        this.client.setQueryData(this.keyOf(page), patched(rows, change.shapeId, change.known));
        this.pages.add(page);
        this.shapeIds.add(change.shapeId);
      }
    }
    if (this.pages.size > 0) this.soon.within(change === "in sight" ? STAGE_MS : GATHER_MS);
  }

  /** From now on nobody keeps the pages true: whoever comes back to them reads them anew. */
  stop(): void {
    this.soon.stop();
    this.stopping.abort();
    void this.client.invalidateQueries({ queryKey: listKey(this.list), refetchType: "none" });
  }

  /** A page out of sight is read when it comes into sight again. */
  private takeInSight(page: number): void {
    const queryKey = this.keyOf(page);
    if (this.client.getQueryCache().find({ queryKey })?.isActive()) this.pages.add(page);
    else void this.client.invalidateQueries({ queryKey, refetchType: "none" });
  }

  private async read(): Promise<void> {
    const pages = [...this.pages];
    this.pages.clear();
    const changed = [...this.shapeIds];
    this.shapeIds.clear();
    const unread: number[] = [];
    for (const page of pages) {
      if (!(await this.renew(page, changed))) unread.push(page);
    }
    if (this.stopping.signal.aborted) return;
    if (unread.length === 0) this.nFailures = 0;
    else this.tryAgain(unread, changed);
  }

  /** The service could not be reached, which the bar shows. */
  private tryAgain(pages: readonly number[], changed: readonly number[]): void {
    for (const page of pages) this.pages.add(page);
    for (const id of changed) this.shapeIds.add(id);
    this.soon.within(Math.min(LONGEST_RETRY_MS, RETRY_MS * 2 ** this.nFailures));
    this.nFailures += 1;
  }

  /** Whether the page is as the service has it now, or not held any more. */
  private async renew(page: number, changed: readonly number[]): Promise<boolean> {
    const before = this.client.getQueryData<RowPage>(this.keyOf(page));
    if (before === undefined) return true;
    try {
      const fresh = await fetchRows(this.list, page * PAGE_ROWS, PAGE_ROWS, this.stopping.signal);
      const held = this.client.getQueryData<RowPage>(this.keyOf(page)) ?? before;
      const gone = await this.goneFrom(held, fresh, changed);
      if (this.stopping.signal.aborted) return false;
      if (held.n_shapes > 0 && isReordered(held, fresh)) this.onReordered(fresh.n_shapes - held.n_shapes);
      const known = { ...fresh, items: [...fresh.items, ...gone] };
      this.client.setQueryData(this.keyOf(page), renewed(held, known));
      return true;
    } catch {
      return false;
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
