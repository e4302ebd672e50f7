import { useMemo } from "react";
import { count } from "../../../components/numbers";
import { useObservable } from "../../../drafts/useObservable";
import { effortOf, IDLE_AFTER_MS } from "../../../labels/effort";
import type { OpenShape } from "../shape/openShape";
import styles from "./EffortLine.module.css";

/** What the shape in hand has cost so far, as it will be on record. */
export function EffortLine({ open }: { open: OpenShape }) {
  const version = useObservable(open.version);
  // biome-ignore lint/correctness/useExhaustiveDependencies: the log grows in place; the version says when
  const { activeMs, nClicks } = useMemo(
    () => effortOf(open.draft.strokes, open.draft.draft.created_at),
    [open, version],
  );
  return (
    <p
      className={styles.effort}
      title={`As it will be on record: time from stroke to stroke without pauses of more than ${IDLE_AFTER_MS / 1000} s, and every press. Taking labels to start from is one.`}
    >
      {minutesAndSeconds(activeMs)} at work · {count(nClicks, "click")}
    </p>
  );
}

/** "1:05", as on a stopwatch. */
function minutesAndSeconds(ms: number): string {
  const seconds = Math.floor(ms / 1000);
  return `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
}
