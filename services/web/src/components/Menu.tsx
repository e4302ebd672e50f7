import { type KeyboardEvent, type ReactNode, useId, useLayoutEffect, useRef, useState } from "react";
import { classes } from "./classes";
import styles from "./Menu.module.css";
import { type Alignment, placeBeside } from "./placement";

export interface MenuProps {
  /** The button's accessible name. */
  label: string;
  /** What the button shows; its name if left out. */
  trigger?: ReactNode;
  /** MenuItem, MenuChoice, MenuHeading and MenuLine. */
  children: ReactNode;
  alignment?: Alignment;
  /** "quiet": no frame until it is pointed at. "framed": like a small secondary button. */
  variant?: "quiet" | "framed";
  /** Of the button, in place of its own looks. */
  className?: string | undefined;
  isDisabled?: boolean;
}

const ITEMS = '[role^="menuitem"]:not(:disabled, [aria-disabled="true"])';

/** A button with a menu: a native popover, closed by Escape, a click elsewhere, or a choice. */
export function Menu({
  label,
  trigger,
  children,
  alignment = "start",
  variant = "quiet",
  className,
  isDisabled = false,
}: MenuProps) {
  const id = useId();
  const button = useRef<HTMLButtonElement>(null);
  const menu = useRef<HTMLDivElement>(null);
  const [isOpen, setOpen] = useState(false);

  useLayoutEffect(() => {
    if (!isOpen || !button.current || !menu.current) return; // its items are there only while it is open
    placeBeside(menu.current, button.current, alignment);
    const found = itemsOf(menu.current);
    const isOfChoices = found[0]?.role !== "menuitem"; // else what is checked further down is not what people came for
    (found.find((item) => isOfChoices && item.ariaChecked === "true") ?? found[0])?.focus();
  }, [isOpen, alignment]);

  const onKeyDown = (event: KeyboardEvent) => {
    const next = nextFocus(itemsOf(menu.current), event.key);
    if (event.key === "Tab") menu.current?.hidePopover();
    if (!next) return;
    event.preventDefault();
    event.stopPropagation();
    next.focus();
  };
  return (
    <>
      <button
        ref={button}
        type="button"
        className={className ?? classes(styles.trigger, styles[variant])}
        aria-label={trigger === undefined ? undefined : label}
        aria-haspopup="menu"
        aria-expanded={isOpen}
        popoverTarget={id}
        disabled={isDisabled}
      >
        {trigger ?? label}
      </button>
      <div
        ref={menu}
        id={id}
        popover="auto"
        role="menu"
        tabIndex={-1}
        aria-label={label}
        className={styles.menu}
        onToggle={(event) => {
          setOpen(event.newState === "open");
        }}
        onKeyDown={onKeyDown}
        onClick={(event) => (event.target as Element).closest(ITEMS) && menu.current?.hidePopover()}
      >
        {isOpen && children}
      </div>
    </>
  );
}

function itemsOf(menu: HTMLElement | null): readonly HTMLElement[] {
  return [...(menu?.querySelectorAll<HTMLElement>(ITEMS) ?? [])];
}

function nextFocus(items: readonly HTMLElement[], key: string): HTMLElement | undefined {
  const at = items.findIndex((item) => item.matches(":focus"));
  if (key === "ArrowDown") return items[(at + 1) % items.length];
  if (key === "ArrowUp") return items.at(at <= 0 ? -1 : at - 1);
  if (key === "Home") return items[0];
  if (key === "End") return items.at(-1);
  if (key.length !== 1 || key === " ") return undefined;
  const after = [...items.slice(at + 1), ...items.slice(0, at + 1)];
  return after.find((item) => item.textContent?.trim().toLowerCase().startsWith(key.toLowerCase()));
}
