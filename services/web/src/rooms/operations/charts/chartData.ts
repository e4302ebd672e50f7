/** What a chart shows. */

export interface ChartLine {
  name: string;
  /** A value for each x; null where there is none. */
  values: readonly (number | null)[];
}

export interface ChartData {
  /** Seconds since 1970 for times, else plain numbers. */
  x: readonly number[];
  lines: readonly ChartLine[];
  /** The largest y that is always in sight, such as 1 for shares. */
  top?: number;
  isTime: boolean;
  format: (value: number) => string;
}
