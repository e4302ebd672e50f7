import type { ReactNode, TextareaHTMLAttributes } from "react";
import { classes } from "./classes";
import { Field } from "./Field";
import styles from "./Input.module.css";

export interface TextAreaProps extends TextareaHTMLAttributes<HTMLTextAreaElement> {
  label: string;
  hint?: ReactNode;
  error?: string | null | undefined;
}

/** Lines of text, with their label: an Input that grows downwards. */
export function TextArea({ label, hint, error, className, ...rest }: TextAreaProps) {
  return (
    <Field label={label} hint={hint} error={error} className={className}>
      {(control) => <textarea {...rest} {...control} className={classes(styles.input, styles.lines)} />}
    </Field>
  );
}
