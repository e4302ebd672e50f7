import { useMemo } from "react";
import { classes } from "../components";
import { whole } from "../components/numbers";
import { type Colouring, clusterColour, STATE_TOKENS } from "./colours";
import styles from "./EmbeddingMap.module.css";
import { clusterSizes, type MapPoints, NO_CLUSTER, POINT_STATES, type PointState } from "./mapPoints";

export const STATE_WORDS: Readonly<Record<PointState, string>> = {
  new: "New",
  failed: "Failed",
  ready: "Ready",
  review: "In review",
  confirmed: "Confirmed",
};

export interface MapLegendProps {
  readonly points: MapPoints;
  readonly colouring: Colouring;
  readonly cluster: number | null;
  onCluster(cluster: number | null): void;
}

/** What colours mean. A cluster limits the table to its shapes. */
export function MapLegend({ points, colouring, cluster, onCluster }: MapLegendProps) {
  const sizes = useMemo(() => clusterSizes(points), [points]);
  const states = useMemo(() => stateSizes(points), [points]);
  const nLoose = useMemo(() => points.cluster.filter((each) => each === NO_CLUSTER).length, [points]);
  const nFirst = useMemo(() => points.isFirst.reduce((sum, each) => sum + each, 0), [points]);
  return (
    <div className={styles.legend}>
      <ul className={styles.kinds} aria-label={colouring === "cluster" ? "Clusters" : "States"}>
        {colouring === "cluster"
          ? [...sizes].map(([each, n]) => (
              <li key={each}>
                <button
                  type="button"
                  className={classes(styles.kind, each === cluster && styles.only)}
                  aria-pressed={each === cluster}
                  title={
                    each === cluster
                      ? "Show all clusters in the table"
                      : "Show only this cluster in the table"
                  }
                  onClick={() => onCluster(each === cluster ? null : each)}
                >
                  <span className={styles.dot} style={{ background: clusterColour(each) }} />
                  <span className="unseen">Cluster </span>
                  {each + 1}
                  <span className={styles.number}>{whole(n)}</span>
                </button>
              </li>
            ))
          : POINT_STATES.map((state, i) => (
              <li key={state} className={styles.kind}>
                <span className={styles.dot} style={{ background: `var(${STATE_TOKENS[i]})` }} />
                {STATE_WORDS[state]}
                <span className={styles.number}>{whole(states[i] ?? 0)}</span>
              </li>
            ))}
        {colouring === "cluster" && nLoose > 0 && (
          <li className={styles.kind}>
            <span className={styles.dot} style={{ background: `var(${STATE_TOKENS[0]})` }} />
            In no cluster
            <span className={styles.number}>{whole(nLoose)}</span>
          </li>
        )}
      </ul>
      {nFirst > 0 && (
        <p className={styles.first}>
          <span className={styles.diamond} aria-hidden="true" /> Chosen to be labelled first ({whole(nFirst)})
        </p>
      )}
    </div>
  );
}

function stateSizes(points: MapPoints): number[] {
  const sizes = POINT_STATES.map(() => 0);
  for (const state of points.state) sizes[state] = (sizes[state] ?? 0) + 1;
  return sizes;
}
