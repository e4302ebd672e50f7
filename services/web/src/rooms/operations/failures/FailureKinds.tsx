import { count } from "../../../components/numbers";
import type { FailureKind, Ops } from "../queries";
import styles from "./FailuresPanel.module.css";
import { FAILURE_WORDS } from "./failureWords";

/** How many failures there are of each kind, and what to do about them. */
export function FailureKinds({ ops }: { ops: Ops }) {
  const kinds = Object.entries(ops.failures) as [FailureKind, number][];
  const seen = kinds.filter(([, n]) => n > 0);
  if (seen.length === 0) return null;
  return (
    <ul className={styles.kinds} aria-label="Failures by kind">
      {seen.map(([kind, n]) => (
        <li key={kind}>
          <strong>{count(n, "failure")}</strong> · {FAILURE_WORDS[kind].name}
          <span className={styles.advice}> {FAILURE_WORDS[kind].advice}</span>
        </li>
      ))}
    </ul>
  );
}
