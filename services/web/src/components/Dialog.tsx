import { X } from "lucide-react";
import { type ReactNode, useEffect, useId, useRef } from "react";
import { classes } from "./classes";
import styles from "./Dialog.module.css";
import { IconButton } from "./IconButton";
import { useToastHost } from "./toastHost";

export interface DialogProps {
  title: string;
  /** Escape, the cross, or a click beside it. Without it the dialog stays until it is answered. */
  onClose?: (() => void) | undefined;
  children: ReactNode;
  /** Buttons, the one that goes on last. */
  footer?: ReactNode;
  size?: "small" | "normal" | "wide";
  /** Asks before something happens: announced with its text. */
  isAlert?: boolean;
}

/** A native modal dialog, open for as long as it is rendered. The browser keeps the focus in it, and gives it back. */
export function Dialog({ title, onClose, children, footer, size = "normal", isAlert = false }: DialogProps) {
  const dialog = useRef<HTMLDialogElement>(null);
  const id = useId();
  useEffect(() => {
    const shown = dialog.current;
    shown?.showModal();
    firstToFocus(shown)?.focus();
    return () => shown?.close();
  }, []);
  useToastHost(dialog);
  return (
    <dialog
      ref={dialog}
      tabIndex={-1}
      className={classes(styles.dialog, styles[size])}
      role={isAlert ? "alertdialog" : undefined}
      aria-labelledby={`${id}-title`}
      aria-describedby={isAlert ? `${id}-body` : undefined}
      onCancel={(event) => {
        event.preventDefault();
        onClose?.();
      }}
      onKeyDown={(event) => {
        event.stopPropagation(); // a room's own keys rest while a dialog is open
        if (event.key === "Escape" && onClose === undefined) event.preventDefault();
      }}
      onClick={(event) => event.target === dialog.current && onClose?.()}
    >
      <div className={styles.frame}>
        <header className={styles.header}>
          <h2 id={`${id}-title`}>{title}</h2>
          {onClose && <IconButton label="Close" size="small" icon={<X />} onClick={onClose} />}
        </header>
        <div id={`${id}-body`} className={styles.body}>
          {children}
        </div>
        {footer !== undefined && <footer className={styles.footer}>{footer}</footer>}
      </div>
    </dialog>
  );
}

/** What people came for: the first field, else the first answer, else the text. The browser itself would take the cross. */
function firstToFocus(dialog: HTMLDialogElement | null): HTMLElement | null | undefined {
  return (
    dialog?.querySelector<HTMLElement>("input:not([type=hidden], :disabled), select, textarea") ??
    dialog?.querySelector<HTMLElement>("footer button") ??
    dialog
  );
}
