import type { ButtonHTMLAttributes, ReactNode } from "react";
import styles from "./Button.module.css";
import { classes } from "./classes";
import { Spinner } from "./Spinner";

export type ButtonVariant = "primary" | "secondary" | "quiet" | "danger";

export interface ButtonProps extends ButtonHTMLAttributes<HTMLButtonElement> {
  variant?: ButtonVariant;
  size?: "normal" | "small";
  icon?: ReactNode;
  /** Something is under way: shows it, and takes no clicks, but keeps the focus. */
  isBusy?: boolean;
}

export function Button(props: ButtonProps) {
  const {
    variant = "secondary",
    size = "normal",
    icon,
    isBusy = false,
    children,
    className,
    onClick,
    ...rest
  } = props;
  const shown = classes(styles.button, styles[variant], size === "small" && styles.small, className);
  return (
    <button
      type="button"
      {...rest}
      className={shown}
      aria-busy={isBusy || undefined}
      aria-disabled={isBusy || undefined}
      onClick={isBusy ? (event) => event.preventDefault() : onClick}
    >
      {isBusy ? <Spinner /> : icon}
      {children !== undefined && <span className={styles.text}>{children}</span>}
    </button>
  );
}
