import { X } from "lucide-react";
import { createContext, type ReactNode, useCallback, useContext, useMemo, useRef, useState } from "react";
import { createPortal } from "react-dom";
import { classes } from "./classes";
import { IconButton } from "./IconButton";
import styles from "./Toasts.module.css";
import { type HostToasts, ToastHostContext } from "./toastHost";

const SHOWN_MS = 6_000;
const MAX_SHOWN = 4;

export interface Toast {
  message: string;
  tone?: "neutral" | "good" | "bad";
  /** Such as "Undo" or "Try again". A toast that has one, or that tells of a fault, stays until it is closed. */
  action?: { label: string; onSelect: () => void };
}

interface ShownToast extends Toast {
  id: number;
}

export type ShowToast = (toast: Toast) => void;

const ToastContext = createContext<ShowToast>(() => {
  throw new Error("useToast needs a ToastProvider above it");
});

/** Shows a short message in the corner, which screen readers read out. */
export function useToast(): ShowToast {
  return useContext(ToastContext);
}

export function ToastProvider({ children }: { children: ReactNode }) {
  const [toasts, setToasts] = useState<readonly ShownToast[]>([]);
  const [hosts, setHosts] = useState<readonly HTMLElement[]>([]);
  const lastId = useRef(0);
  const close = useCallback((id: number) => setToasts((shown) => shown.filter((each) => each.id !== id)), []);
  const show = useCallback<ShowToast>(
    (toast) => {
      lastId.current += 1;
      const id = lastId.current;
      setToasts((shown) =>
        [...shown.filter((each) => each.message !== toast.message), { ...toast, id }].slice(-MAX_SHOWN),
      );
      if (toast.tone !== "bad" && !toast.action) window.setTimeout(() => close(id), SHOWN_MS);
    },
    [close],
  );
  const hostToasts = useCallback<HostToasts>((host) => {
    setHosts((open) => [...open, host]);
    return () => setHosts((open) => open.filter((each) => each !== host));
  }, []);
  const urgent = useMemo(() => toasts.filter((each) => each.tone === "bad"), [toasts]);
  const calm = useMemo(() => toasts.filter((each) => each.tone !== "bad"), [toasts]);
  return (
    <ToastContext value={show}>
      <ToastHostContext value={hostToasts}>{children}</ToastHostContext>
      {createPortal(
        <div className={styles.corner}>
          <ToastList toasts={urgent} politeness="assertive" onClose={close} />
          <ToastList toasts={calm} politeness="polite" onClose={close} />
        </div>,
        hosts.at(-1) ?? document.body,
      )}
    </ToastContext>
  );
}

function ToastList(props: {
  toasts: readonly ShownToast[];
  politeness: "polite" | "assertive";
  onClose: (id: number) => void;
}) {
  return (
    <div aria-live={props.politeness} className={styles.list}>
      {props.toasts.map((toast) => (
        <div
          key={toast.id}
          role={toast.tone === "bad" ? "alert" : "status"}
          className={classes(styles.toast, toast.tone && styles[toast.tone])}
        >
          <p className={styles.message}>{toast.message}</p>
          {toast.action && (
            <button
              type="button"
              className={styles.action}
              onClick={() => {
                toast.action?.onSelect();
                props.onClose(toast.id);
              }}
            >
              {toast.action.label}
            </button>
          )}
          <IconButton label="Dismiss" size="small" icon={<X />} onClick={() => props.onClose(toast.id)} />
        </div>
      ))}
    </div>
  );
}
