/** Rows of a stretch of a list, whether or not they are on screen. */
import { useQueryClient } from "@tanstack/react-query";
import { useCallback } from "react";
import { PAGE_ROWS, pagesOf, type RowPage, type ShapeRow } from "./shapeRows";
import { fetchRows, pageQuery, type RowList } from "./tableQueries";

export type ReadRange = (first: number, count: number) => Promise<readonly ShapeRow[]>;

/** From pages that are held where all of them are, else from the service. */
export function useRange(list: RowList): ReadRange {
  const client = useQueryClient();
  return useCallback(
    async (first, count) => {
      const pages = pagesOf(first, first + count - 1);
      const held = pages.map((page) => client.getQueryData<RowPage>(pageQuery(list, page).queryKey));
      if (held.every((page) => page !== undefined)) {
        const begin = (pages[0] ?? 0) * PAGE_ROWS;
        return held.flatMap((page) => page.items).slice(first - begin, first - begin + count);
      }
      return (await fetchRows(list, first, count)).items;
    },
    [client, list],
  );
}
