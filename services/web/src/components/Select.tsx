import { ChevronDown } from "lucide-react";
import type { ReactNode } from "react";
import { classes } from "./classes";
import { Field } from "./Field";
import styles from "./Select.module.css";

export interface SelectOption<T extends string> {
  value: T;
  label: string;
  isDisabled?: boolean;
}

export interface SelectProps<T extends string> {
  label: string;
  options: readonly SelectOption<T>[];
  value: T;
  onChange: (value: T) => void;
  isLabelUnseen?: boolean;
  hint?: ReactNode;
  error?: string | null | undefined;
  isDisabled?: boolean;
  size?: "normal" | "small";
  className?: string;
  title?: string;
}

/** One of several, by the browser's own menu. */
export function Select<T extends string>(props: SelectProps<T>) {
  const { label, options, value, onChange, isLabelUnseen = false, hint, error, isDisabled = false } = props;
  const { size = "normal", className, title } = props;
  return (
    <Field label={label} hint={hint} error={error} isLabelUnseen={isLabelUnseen} className={className}>
      {(control) => (
        <span className={classes(styles.frame, size === "small" && styles.small)}>
          <select
            {...control}
            className={styles.select}
            value={value}
            title={title}
            disabled={isDisabled}
            onChange={(event) => onChange(event.target.value as T)}
          >
            {options.map((option) => (
              <option key={option.value} value={option.value} disabled={option.isDisabled}>
                {option.label}
              </option>
            ))}
          </select>
          <ChevronDown className={styles.arrow} aria-hidden="true" />
        </span>
      )}
    </Field>
  );
}
