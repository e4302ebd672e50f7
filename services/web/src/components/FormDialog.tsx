import { type FormEvent, type ReactNode, useId } from "react";
import { Button } from "./Button";
import { Dialog, type DialogProps } from "./Dialog";
import styles from "./FormDialog.module.css";

export interface FormDialogProps extends Pick<DialogProps, "title" | "size"> {
  /** What the button says that sends the form, such as "Add". Enter in a field does the same. */
  verb: string;
  /** Whether there is enough to send. */
  isReady?: boolean;
  isBusy: boolean;
  onSubmit: () => void;
  onClose: () => void;
  children: ReactNode;
}

/** Fields that are filled in and sent, or left. */
export function FormDialog(props: FormDialogProps) {
  const { title, size = "normal", verb, isReady = true, isBusy, onSubmit, onClose, children } = props;
  const id = useId();
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (isReady && !isBusy) onSubmit();
  };
  return (
    <Dialog
      title={title}
      size={size}
      onClose={onClose}
      footer={
        <>
          <Button onClick={onClose}>Cancel</Button>
          <Button type="submit" form={id} variant="primary" isBusy={isBusy} disabled={!isReady}>
            {verb}
          </Button>
        </>
      }
    >
      <form id={id} className={styles.form} onSubmit={submit}>
        {children}
      </form>
    </Dialog>
  );
}
