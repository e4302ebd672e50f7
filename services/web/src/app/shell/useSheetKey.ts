import { useEffect } from "react";
import { isTyping } from "./isTyping";

/** "?" asks for the sheet of keys, unless it is text or somebody else answers. */
export function useSheetKey(isHere: boolean, onAsked: () => void): void {
  useEffect(() => {
    if (!isHere) return undefined;
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.key === "?" && !event.defaultPrevented && !isTyping(event.target)) onAsked();
    };
    window.addEventListener("keydown", onKeyDown);
    return () => window.removeEventListener("keydown", onKeyDown);
  }, [isHere, onAsked]);
}
