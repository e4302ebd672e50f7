import { type ReactNode, useId } from "react";
import styles from "./Checkbox.module.css";
import { classes } from "./classes";

export interface CheckboxProps {
  label: ReactNode;
  isChecked: boolean;
  onChange: (isChecked: boolean) => void;
  hint?: ReactNode;
  isDisabled?: boolean;
  isLabelUnseen?: boolean;
  /** Some of several are. */
  isMixed?: boolean;
  className?: string;
}

export function Checkbox(props: CheckboxProps) {
  const {
    label,
    isChecked,
    onChange,
    hint,
    isDisabled = false,
    isLabelUnseen = false,
    isMixed = false,
  } = props;
  const id = useId();
  return (
    <div className={classes(styles.checkbox, props.className)}>
      <input
        id={id}
        type="checkbox"
        className={styles.box}
        checked={isChecked}
        disabled={isDisabled}
        aria-describedby={hint === undefined ? undefined : `${id}-hint`}
        ref={(box) => {
          if (box) box.indeterminate = isMixed;
        }}
        onChange={(event) => onChange(event.target.checked)}
      />
      <label htmlFor={id} className={isLabelUnseen ? "unseen" : styles.label}>
        {label}
      </label>
      {hint !== undefined && (
        <div id={`${id}-hint`} className={styles.hint}>
          {hint}
        </div>
      )}
    </div>
  );
}
