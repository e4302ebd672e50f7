import { useRef } from "react";
import styles from "./Chart.module.css";
import type { ChartData } from "./chartData";
import { DASHES, N_SERIES_COLOURS } from "./seriesColours";
import { useLineChart } from "./useLineChart";

/** Lines over time or rounds, with a legend that says the latest values: all that a chart tells is there in words. */
export function Chart({ label, data, wait }: { label: string; data: ChartData; wait: string }) {
  const place = useRef<HTMLDivElement>(null);
  const isRefused = useLineChart(place, data);
  const note = isRefused
    ? "This browser cannot draw the chart; the figures are below."
    : data.x.length < 2
      ? wait
      : null;
  return (
    <figure className={styles.chart} aria-label={label}>
      <div className={styles.plot}>
        <div ref={place} aria-hidden="true" />
        {note !== null && <p className={styles.wait}>{note}</p>}
      </div>
      <figcaption>
        <ul className={styles.legend}>
          {data.lines.map((line, index) => (
            <li key={line.name} className={styles.entry}>
              <LineSample index={index} />
              <span>{line.name}</span>
              <span className={styles.latest}>{latestOf(line.values, data.format)}</span>
            </li>
          ))}
        </ul>
      </figcaption>
    </figure>
  );
}

function LineSample({ index }: { index: number }) {
  return (
    <svg width="22" height="6" aria-hidden="true" className={styles.sample}>
      <line
        x1="0"
        y1="3"
        x2="22"
        y2="3"
        style={{ stroke: `var(--series-${(index % N_SERIES_COLOURS) + 1})` }}
        strokeWidth="2"
        strokeDasharray={(DASHES[index % DASHES.length] ?? []).join(" ")}
      />
    </svg>
  );
}

function latestOf(values: readonly (number | null)[], format: (value: number) => string): string {
  const latest = values.findLast((value) => value !== null);
  return latest === undefined || latest === null ? "–" : format(latest);
}
