/** Rows of a list around a window of places; pages outside it are dropped from memory after a while. */
import { useQueries } from "@tanstack/react-query";
import { useEffect, useRef, useState } from "react";
import { PAGE_ROWS, pagesOf, type RowPage, type ShapeRow } from "./shapeRows";
import { listKey, pageQuery, type RowList } from "./tableQueries";

/** Pages that only fly past while the scrollbar is dragged are not asked for. */
const SETTLED_MS = 90;

export interface ShapeRows {
  /** Null until the first page is there. */
  readonly nShapes: number | null;
  /** When the order was made, where it is one that is made from time to time. */
  readonly builtAt: string | null;
  readonly error: Error | null;
  rowAt(place: number): ShapeRow | undefined;
  retry(): void;
}

export function useShapeRows(list: RowList, first: number, last: number): ShapeRows {
  const pages = useSettled(pagesOf(Math.max(0, first), Math.max(0, last)));
  const results = useQueries({ queries: pages.map((page) => pageQuery(list, page)) });
  const key = JSON.stringify(listKey(list));
  const held = useRef<{ key: string; page: RowPage } | null>(null);
  const newest = results.find((result) => result.data !== undefined)?.data;
  if (newest !== undefined) held.current = { key, page: newest };
  const known = held.current?.key === key ? held.current.page : null;
  return {
    nShapes: known?.n_shapes ?? null,
    builtAt: known?.built_at ?? null,
    error: results.find((result) => result.error !== null)?.error ?? null,
    rowAt: (place) => results[pages.indexOf(Math.floor(place / PAGE_ROWS))]?.data?.items[place % PAGE_ROWS],
    retry: () => {
      for (const result of results) if (result.error !== null) void result.refetch();
    },
  };
}

/** The pages, at once where some of them are shown already, else once they stay the same for a moment. */
function useSettled(pages: readonly number[]): readonly number[] {
  const [settled, setSettled] = useState(pages);
  const wanted = pages.join();
  const isNear = pages.some((page) => settled.includes(page));
  const isSame = wanted === settled.join();
  // biome-ignore lint/correctness/useExhaustiveDependencies: `wanted` stands for the pages
  useEffect(() => {
    if (isSame) return undefined;
    const timer = window.setTimeout(() => setSettled(pages), isNear ? 0 : SETTLED_MS);
    return () => window.clearTimeout(timer);
  }, [wanted, isNear, isSame]);
  return isNear ? pages : settled;
}
