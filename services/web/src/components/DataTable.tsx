import type { ReactNode } from "react";
import { classes } from "./classes";
import styles from "./DataTable.module.css";

export interface Column<Row> {
  /** Unique among the columns. */
  id: string;
  header: ReactNode;
  cell: (row: Row) => ReactNode;
  /** Numbers end together. */
  isNumber?: boolean;
  /** Takes the width that is left, and is cut off where that is too little. */
  isWide?: boolean;
}

export interface DataTableProps<Row> {
  /** What the table shows, for screen readers. */
  caption: string;
  columns: readonly Column<Row>[];
  rows: readonly Row[];
  keyOf: (row: Row) => string | number;
  /** In place of rows when there are none. */
  empty: ReactNode;
  isBusy?: boolean;
}

/** A plain table for some tens of rows. It scrolls sideways where it does not fit; the first column names the row. */
export function DataTable<Row>({
  caption,
  columns,
  rows,
  keyOf,
  empty,
  isBusy = false,
}: DataTableProps<Row>) {
  return (
    // biome-ignore lint/a11y/useSemanticElements: no fieldset, and no landmark beside the panel's own
    // biome-ignore lint/a11y/noNoninteractiveTabindex: what scrolls must be reachable by keys
    <div role="group" className={styles.scroll} aria-label={caption} tabIndex={0}>
      <table className={styles.table} aria-busy={isBusy}>
        <caption className="unseen">{caption}</caption>
        <thead>
          <tr>
            {columns.map((column) => (
              <th key={column.id} scope="col" className={classOf(column)}>
                {column.header}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {rows.map((row) => (
            <tr key={keyOf(row)}>
              {columns.map((column) => (
                <td key={column.id} className={classOf(column)}>
                  {column.cell(row)}
                </td>
              ))}
            </tr>
          ))}
          {rows.length === 0 && (
            <tr>
              <td colSpan={columns.length} className={styles.empty}>
                {empty}
              </td>
            </tr>
          )}
        </tbody>
      </table>
    </div>
  );
}

function classOf<Row>({ isNumber, isWide }: Column<Row>): string {
  return classes(isNumber && styles.number, isWide && styles.wide);
}
