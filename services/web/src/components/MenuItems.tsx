import type { ReactNode } from "react";
import { classes } from "./classes";
import styles from "./Menu.module.css";

export interface MenuItemProps {
  children: ReactNode;
  onSelect: () => void;
  icon?: ReactNode;
  shortcut?: string | undefined;
  isDisabled?: boolean;
  tone?: "normal" | "danger";
}

/** What a menu does. */
export function MenuItem({
  children,
  onSelect,
  icon,
  shortcut,
  isDisabled = false,
  tone = "normal",
}: MenuItemProps) {
  return (
    <button
      type="button"
      role="menuitem"
      tabIndex={-1}
      className={classes(styles.item, tone === "danger" && styles.danger)}
      disabled={isDisabled}
      onClick={onSelect}
    >
      <span className={styles.mark}>{icon}</span>
      <span className={styles.words}>{children}</span>
      {shortcut !== undefined && <kbd>{shortcut}</kbd>}
    </button>
  );
}

export interface MenuChoiceProps {
  children: ReactNode;
  isChecked: boolean;
  onSelect: () => void;
  /** Several may be chosen. */
  isMultiple?: boolean;
  icon?: ReactNode;
  isDisabled?: boolean;
}

/** What a menu sets: one of several, or each by itself. */
export function MenuChoice(props: MenuChoiceProps) {
  const { children, isChecked, onSelect, isMultiple = false, icon, isDisabled = false } = props;
  return (
    // biome-ignore lint/a11y/useAriaPropsSupportedByRole: both roles that it may have support aria-checked
    <button
      type="button"
      role={isMultiple ? "menuitemcheckbox" : "menuitemradio"}
      aria-checked={isChecked}
      tabIndex={-1}
      className={styles.item}
      disabled={isDisabled}
      onClick={onSelect}
    >
      <span className={styles.mark}>{icon}</span>
      <span className={styles.words}>{children}</span>
      <span className={styles.tick} aria-hidden="true">
        {isChecked ? "✓" : ""}
      </span>
    </button>
  );
}

export function MenuHeading({ children }: { children: ReactNode }) {
  return (
    <p className={styles.heading} role="presentation">
      {children}
    </p>
  );
}

export function MenuLine() {
  return <hr className={styles.line} />;
}
