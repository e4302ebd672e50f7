import { type ReactNode, useId } from "react";
import { classes } from "./classes";
import styles from "./Field.module.css";

/** What the control inside a field must carry. */
export interface FieldControl {
  id: string;
  "aria-describedby": string | undefined;
  "aria-invalid": true | undefined;
}

export interface FieldProps {
  label: string;
  hint?: ReactNode;
  /** What is wrong and what to do; shown in place of nothing, and announced. */
  error?: string | null | undefined;
  /** The label is only for screen readers. */
  isLabelUnseen?: boolean;
  className?: string | undefined;
  children: (control: FieldControl) => ReactNode;
}

/** A label, a control, what it means, and what is wrong with it. */
export function Field({ label, hint, error, isLabelUnseen = false, className, children }: FieldProps) {
  const id = useId();
  const described = [hint !== undefined && `${id}-hint`, error && `${id}-error`].filter(Boolean).join(" ");
  return (
    <div className={classes(styles.field, className)}>
      <label htmlFor={id} className={isLabelUnseen ? "unseen" : styles.label}>
        {label}
      </label>
      {children({ id, "aria-describedby": described || undefined, "aria-invalid": error ? true : undefined })}
      {hint !== undefined && (
        <div id={`${id}-hint`} className={styles.hint}>
          {hint}
        </div>
      )}
      {error && (
        <p id={`${id}-error`} className={styles.error} role="alert">
          {error}
        </p>
      )}
    </div>
  );
}
