import { classes } from "./classes";
import styles from "./Progress.module.css";

/** How far something is. Without a value it moves, as nobody knows. */
export function Progress(props: {
  label: string;
  value?: number | undefined;
  max?: number;
  className?: string;
}) {
  const { label, value, max = 1, className } = props;
  const isKnown = value !== undefined && max > 0;
  const width = isKnown ? `${Math.min(100, (value / max) * 100)}%` : undefined;
  return (
    <div
      role="progressbar"
      aria-label={label}
      aria-valuemin={0}
      aria-valuemax={max}
      aria-valuenow={isKnown ? value : undefined}
      className={classes(styles.track, className)}
    >
      <div className={classes(styles.bar, !isKnown && styles.unknown)} style={{ width }} />
    </div>
  );
}
