import { type ReactNode, useId } from "react";
import { classes } from "./classes";
import styles from "./Segmented.module.css";

export interface SegmentedOption<T extends string> {
  value: T;
  /** Its accessible name, and what is shown if there is no icon. */
  label: string;
  icon?: ReactNode;
  isDisabled?: boolean;
}

export interface SegmentedProps<T extends string> {
  /** What is chosen here, for screen readers. */
  label: string;
  options: readonly SegmentedOption<T>[];
  value: T;
  onChange: (value: T) => void;
  size?: "normal" | "small";
  className?: string;
}

/** One of few, all in sight: radio buttons that look like one control. Arrow keys move. */
export function Segmented<T extends string>(props: SegmentedProps<T>) {
  const { label, options, value, onChange, size = "normal", className } = props;
  const name = useId();
  return (
    <fieldset className={classes(styles.group, size === "small" && styles.small, className)}>
      <legend className="unseen">{label}</legend>
      {options.map((option) => (
        <label key={option.value} className={styles.option} title={option.icon ? option.label : undefined}>
          <input
            type="radio"
            className={styles.radio}
            name={name}
            value={option.value}
            checked={option.value === value}
            disabled={option.isDisabled}
            onChange={() => onChange(option.value)}
          />
          <span className={styles.face}>
            {option.icon}
            <span className={option.icon ? "unseen" : undefined}>{option.label}</span>
          </span>
        </label>
      ))}
    </fieldset>
  );
}
