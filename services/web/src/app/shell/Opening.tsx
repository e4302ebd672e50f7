import { Spinner } from "../../components";
import styles from "./Opening.module.css";

/** While the first answers are on their way. */
export function Opening({ label = "Opening" }: { label?: string }) {
  return (
    <div className={styles.opening}>
      <Spinner label={label} />
    </div>
  );
}
