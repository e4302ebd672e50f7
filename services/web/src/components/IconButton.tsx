import type { ButtonHTMLAttributes, ReactNode } from "react";
import { classes } from "./classes";
import styles from "./IconButton.module.css";
import { Tooltip } from "./Tooltip";

export interface IconButtonProps
  extends Omit<ButtonHTMLAttributes<HTMLButtonElement>, "children" | "aria-label"> {
  /** What it does: its accessible name, and its tooltip. */
  label: string;
  icon: ReactNode;
  /** Shown in the tooltip, and told to screen readers, such as "Ctrl+Z". */
  shortcut?: string | undefined;
  /** For buttons that stay down. */
  isPressed?: boolean;
  size?: "normal" | "small";
}

export function IconButton({
  label,
  icon,
  shortcut,
  isPressed,
  size = "normal",
  className,
  ...rest
}: IconButtonProps) {
  return (
    <Tooltip text={label} shortcut={shortcut}>
      <button
        type="button"
        {...rest}
        className={classes(styles.button, size === "small" && styles.small, className)}
        aria-label={label}
        aria-pressed={isPressed}
        aria-keyshortcuts={shortcut?.replace("Ctrl", "Control")}
      >
        {icon}
      </button>
    </Tooltip>
  );
}
