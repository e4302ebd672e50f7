import type { InputHTMLAttributes, ReactNode, Ref } from "react";
import { classes } from "./classes";
import { Field } from "./Field";
import styles from "./Input.module.css";

export interface InputProps extends InputHTMLAttributes<HTMLInputElement> {
  label: string;
  hint?: ReactNode;
  error?: string | null | undefined;
  isLabelUnseen?: boolean;
  /** After the value, such as "%". */
  unit?: string;
  ref?: Ref<HTMLInputElement>;
}

/** A line of text, a number, a date …, with its label. */
export function Input({ label, hint, error, isLabelUnseen = false, unit, className, ...rest }: InputProps) {
  return (
    <Field label={label} hint={hint} error={error} isLabelUnseen={isLabelUnseen} className={className}>
      {(control) => (
        <span className={styles.frame}>
          <input
            {...rest}
            {...control}
            className={classes(styles.input, unit !== undefined && styles.withUnit)}
          />
          {unit !== undefined && <span className={styles.unit}>{unit}</span>}
        </span>
      )}
    </Field>
  );
}
