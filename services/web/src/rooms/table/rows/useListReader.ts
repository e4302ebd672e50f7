/** Rows of a list, whether or not they are on screen. */
import { useQueryClient } from "@tanstack/react-query";
import { useMemo } from "react";
import { PAGE_ROWS, pagesOf, type RowPage, type ShapeRow } from "./shapeRows";
import { pageQuery, type RowList } from "./tableQueries";

export interface ListReader {
  /** `count` rows from a place on. */
  range(first: number, count: number): Promise<readonly ShapeRow[]>;
  /** The first rows that are wanted, `limit` at most. nPassed : rows before them that are not. */
  firstOf(limit: number, isWanted: (row: ShapeRow) => boolean): Promise<WantedRows>;
}

export interface WantedRows {
  readonly rows: readonly ShapeRow[];
  readonly nPassed: number;
}

/** From pages as they are held, for those are what is shown; only the others are asked of the service. */
export function useListReader(list: RowList): ListReader {
  const client = useQueryClient();
  return useMemo(() => {
    const pageAt = async (page: number): Promise<RowPage> => {
      const query = pageQuery(list, page);
      return client.getQueryData(query.queryKey) ?? client.fetchQuery(query);
    };
    return {
      async range(first, count) {
        const numbers = pagesOf(first, first + count - 1);
        const pages = await Promise.all(numbers.map(pageAt));
        const begin = (numbers[0] ?? 0) * PAGE_ROWS;
        return pages.flatMap((page) => page.items).slice(first - begin, first - begin + count);
      },
      firstOf: (limit, isWanted) => firstWanted(pageAt, limit, isWanted),
    };
  }, [client, list]);
}

async function firstWanted(
  pageAt: (page: number) => Promise<RowPage>,
  limit: number,
  isWanted: (row: ShapeRow) => boolean,
): Promise<WantedRows> {
  const rows: ShapeRow[] = [];
  let nPassed = 0;
  for (let page = 0; ; page++) {
    const { items } = await pageAt(page);
    for (const row of items) {
      if (!isWanted(row)) nPassed += 1;
      else if (rows.push(row) === limit) return { rows, nPassed };
    }
    if (items.length < PAGE_ROWS) return { rows, nPassed };
  }
}
