import { type ReactNode, useCallback, useEffect, useId, useRef } from "react";
import { placeBeside } from "./placement";
import styles from "./Tooltip.module.css";

const DELAY_MS = 450;

/**
 * A name that shows beside one control, on hover after a moment and at once on keyboard focus. It repeats what the
 * control is called already, so it is hidden from screen readers.
 */
export function Tooltip(props: { text: string; shortcut?: string | undefined; children: ReactNode }) {
  const { text, shortcut, children } = props;
  const anchor = useRef<HTMLSpanElement>(null);
  const tip = useRef<HTMLSpanElement>(null);
  const timer = useRef<number | undefined>(undefined);
  const id = useId();

  const hide = useCallback(() => {
    window.clearTimeout(timer.current);
    if (tip.current?.matches(":popover-open")) tip.current.hidePopover();
  }, []);
  const show = useCallback(() => {
    const control = anchor.current?.firstElementChild;
    if (!control || !tip.current?.isConnected) return;
    tip.current.showPopover();
    placeBeside(tip.current, control, "centre");
  }, []);
  useEffect(() => () => window.clearTimeout(timer.current), []);

  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: the control inside is what people use; this only watches it
    <span
      ref={anchor}
      className={styles.anchor}
      onPointerOver={(event) => {
        if (event.pointerType === "touch") return;
        window.clearTimeout(timer.current);
        timer.current = window.setTimeout(show, DELAY_MS);
      }}
      onPointerOut={hide}
      onPointerDown={hide}
      onFocus={(event) => event.target.matches(":focus-visible") && show()}
      onBlur={hide}
    >
      {children}
      <span ref={tip} id={id} popover="manual" aria-hidden="true" className={styles.tip}>
        {text}
        {shortcut !== undefined && <kbd className={styles.keys}>{shortcut}</kbd>}
      </span>
    </span>
  );
}
