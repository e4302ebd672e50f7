import type { ReactNode } from "react";
import { Time } from "../../components";
import { count, percent, whole } from "../../components/numbers";
import styles from "./KeyFigures.module.css";
import type { Ops } from "./queries";

/** What an operator looks at first. */
export function KeyFigures({ ops }: { ops: Ops }) {
  const total = sum(Object.values(ops.states));
  const confirmed = ops.states.confirmed ?? 0;
  const failed = ops.stages.reduce((n, stage) => n + stage.failed, 0);
  const { queue } = ops;
  return (
    <dl className={styles.figures}>
      <Figure name="Confirmed" value={whole(confirmed)}>
        of {count(total, "shape")}
        {total > 0 && `, ${percent(confirmed / total)}`}
      </Figure>
      <Figure name="Waiting for a person" value={whole(queue.free)}>
        {queue.oldest_at ? (
          <>
            oldest <Time at={queue.oldest_at} />
          </>
        ) : (
          "the queue is empty"
        )}
      </Figure>
      <Figure name="In someone’s hands" value={whole(queue.held)}>
        {queue.assigned > 0 ? `${whole(queue.assigned)} kept for one person` : "now"}
      </Figure>
      <Figure name="Open reviews" value={whole(ops.open_reviews)}>
        {ops.open_reviews === 0 ? "none to look at" : "wait for a reviewer"}
      </Figure>
      <Figure name="Failures" value={whole(failed)} isBad={failed > 0}>
        {failed === 0 ? "nothing was given up" : "given up, see below"}
      </Figure>
      <Figure name="Model" value={ops.model_version === null ? "–" : `Version ${ops.model_version}`}>
        {ops.model_version === null ? "none trained yet" : "scores and predictions"}
      </Figure>
    </dl>
  );
}

function Figure(props: { name: string; value: string; isBad?: boolean; children: ReactNode }) {
  return (
    <div className={styles.figure}>
      <dt className={styles.name}>{props.name}</dt>
      <dd className={props.isBad ? styles.bad : styles.value}>{props.value}</dd>
      <dd className={styles.note}>{props.children}</dd>
    </div>
  );
}

function sum(values: readonly number[]): number {
  return values.reduce((total, value) => total + value, 0);
}
