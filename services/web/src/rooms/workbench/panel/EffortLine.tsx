import { useMemo } from "react";
import { count } from "../../../components/numbers";
import { useObservableOr } from "../../../drafts/useObservable";
import { type Effort, effortOf, IDLE_AFTER_MS } from "../../../labels/effort";
import type { OpenShape } from "../shape/openShape";
import styles from "./EffortLine.module.css";

/** What the shape in hand has cost so far, as it will be on record. Its place is kept while there is no shape. */
export function EffortLine({ open }: { open: OpenShape | null }) {
  const version = useObservableOr(open?.version, 0);
  // biome-ignore lint/correctness/useExhaustiveDependencies: the log grows in place; the version says when
  const effort = useMemo(
    () => open && effortOf(open.draft.strokes, open.draft.draft.created_at),
    [open, version],
  );
  return (
    <p
      className={styles.effort}
      title={`As it will be on record: time from stroke to stroke without pauses of more than ${IDLE_AFTER_MS / 1000} s, and every press. Taking labels to start from is one.`}
    >
      {effort && inWords(effort)}
    </p>
  );
}

/** "1:05 at work · 12 clicks". */
function inWords({ activeMs, nClicks }: Effort): string {
  const seconds = Math.floor(activeMs / 1000);
  const clock = `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
  return `${clock} at work · ${count(nClicks, "click")}`;
}
