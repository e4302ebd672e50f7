import { classes } from "./classes";
import styles from "./Spinner.module.css";

/** Something is under way. With a label it is told to screen readers and shown; without one it is decoration. */
export function Spinner({ label, className }: { label?: string; className?: string }) {
  const ring = <span className={classes(styles.ring, className)} aria-hidden="true" />;
  if (label === undefined) return ring;
  return (
    <span className={styles.labelled} role="status">
      {ring}
      {label}
    </span>
  );
}
