import { type ReactNode, useId } from "react";
import { classes } from "./classes";
import styles from "./Slider.module.css";

export interface SliderProps {
  label: string;
  value: number;
  min: number;
  max: number;
  step?: number;
  /** While it moves. */
  onChange: (value: number) => void;
  /** When it has been let go, or moved by a key: for what is too costly to do on the way. */
  onCommit?: (value: number) => void;
  /** The value in words, which screen readers read, too. */
  format?: (value: number) => string;
  isDisabled?: boolean;
  hint?: ReactNode;
  className?: string;
}

export function Slider(props: SliderProps) {
  const {
    label,
    value,
    min,
    max,
    step = 1,
    onChange,
    onCommit,
    format = String,
    isDisabled = false,
    hint,
  } = props;
  const id = useId();
  const share = max > min ? ((value - min) / (max - min)) * 100 : 0;
  const commit = (event: { currentTarget: HTMLInputElement }) =>
    onCommit?.(event.currentTarget.valueAsNumber);
  return (
    <div className={classes(styles.slider, props.className)}>
      <label htmlFor={id} className={styles.label}>
        {label}
      </label>
      <output htmlFor={id} className={styles.value}>
        {format(value)}
      </output>
      <input
        id={id}
        type="range"
        className={styles.range}
        style={{ "--share": `${share}%` } as Record<string, string>}
        {...{ value, min, max, step }}
        disabled={isDisabled}
        aria-valuetext={format(value)}
        onChange={(event) => onChange(event.target.valueAsNumber)}
        onPointerUp={commit}
        onKeyUp={commit}
      />
      {hint !== undefined && <div className={styles.hint}>{hint}</div>}
    </div>
  );
}
