import { createContext, type RefObject, useContext, useEffect } from "react";

/** Shows toasts within an element from now on, until what it answers is called. */
export type HostToasts = (host: HTMLElement) => () => void;

export const ToastHostContext = createContext<HostToasts>(() => () => undefined);

/** Toasts are shown within this modal dialog while it is open: all behind it is dimmed, out of reach and unread. */
export function useToastHost(dialog: RefObject<HTMLElement | null>): void {
  const hostToasts = useContext(ToastHostContext);
  useEffect(() => (dialog.current === null ? undefined : hostToasts(dialog.current)), [dialog, hostToasts]);
}
