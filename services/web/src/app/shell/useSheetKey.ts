import { useEffect } from "react";
import { hasOverlay } from "./hasOverlay";
import { isTyping } from "./isTyping";

/** "?" asks for the sheet of keys, unless it is text or somebody else answers. */
export function useSheetKey(isHere: boolean, onAsked: () => void): void {
  useEffect(() => {
    if (!isHere) return undefined;
    const onKeyDown = (event: KeyboardEvent) => {
      const isElsewhere = event.defaultPrevented || isTyping(event.target) || hasOverlay();
      if (event.key === "?" && !isElsewhere) onAsked();
    };
    window.addEventListener("keydown", onKeyDown);
    return () => window.removeEventListener("keydown", onKeyDown);
  }, [isHere, onAsked]);
}
