import type { ReactNode } from "react";
import { Button, Dialog, Notice, Progress } from "../../../components";
import styles from "./Actions.module.css";

export interface ActionDialogProps {
  readonly title: string;
  /** What the button says, such as "Send back". */
  readonly verb: string;
  readonly children: ReactNode;
  readonly isReady?: boolean;
  readonly isBusy: boolean;
  /** Of how many shapes it is known what became of them; for actions that ask shape by shape. */
  readonly progress?: { n: number; of: number } | undefined;
  readonly error: Error | null;
  onConfirm(): void;
  onClose(): void;
}

/** Asks how something is to be done with the shapes that are selected, and shows that it is being done. */
export function ActionDialog(props: ActionDialogProps) {
  const { title, verb, children, isReady = true, isBusy, progress, error, onConfirm, onClose } = props;
  return (
    <Dialog
      title={title}
      onClose={isBusy ? undefined : onClose}
      footer={
        <>
          <Button onClick={onClose} disabled={isBusy}>
            Cancel
          </Button>
          <Button variant="primary" isBusy={isBusy} disabled={!isReady} onClick={onConfirm}>
            {verb}
          </Button>
        </>
      }
    >
      <div className={styles.form}>
        {children}
        {isBusy && progress && <Progress label={title} value={progress.n} max={progress.of} />}
        {error && (
          <Notice kind="error" title="This could not be done">
            {error.message}
          </Notice>
        )}
      </div>
    </Dialog>
  );
}
