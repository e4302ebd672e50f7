import { Button, Notice } from "../../components";
import styles from "./PanelError.module.css";

/** In place of a list that could not be read. */
export function PanelError({ what, error, onRetry }: { what: string; error: Error; onRetry: () => unknown }) {
  return (
    <div className={styles.place}>
      <Notice
        kind="error"
        title={`${what} could not be read`}
        actions={
          <Button size="small" onClick={onRetry}>
            Try again
          </Button>
        }
      >
        {error.message}
      </Notice>
    </div>
  );
}
