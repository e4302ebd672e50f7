import { classes } from "./classes";
import styles from "./Skeleton.module.css";

/** A grey place where something will be, of its size, so that nothing jumps once it is there. */
export function Skeleton(props: { width?: number | string; height?: number | string; className?: string }) {
  const { width = "100%", height = "1em", className } = props;
  return (
    <span aria-hidden="true" className={classes(styles.skeleton, className)} style={{ width, height }} />
  );
}
