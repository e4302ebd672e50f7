import { useEffect, useRef } from "react";
import { isTyping } from "../../../app/shell/isTyping";

/** Ctrl+A anywhere in the room means its shapes: the page's text is not what anybody wants to choose here. */
export function useSelectAllKey(chooseAll: () => void): void {
  const latest = useRef(chooseAll);
  latest.current = chooseAll;
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      const isIt = event.key.toLowerCase() === "a" && (event.ctrlKey || event.metaKey);
      if (!isIt || event.shiftKey || event.altKey || event.defaultPrevented || isTyping(event.target)) return;
      event.preventDefault();
      latest.current();
    };
    window.addEventListener("keydown", onKeyDown);
    return () => window.removeEventListener("keydown", onKeyDown);
  }, []);
}
