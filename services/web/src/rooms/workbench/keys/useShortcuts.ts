/** Listens to the workbench's keys, but where keys are text or belong to a control. */
import { useEffect, useRef } from "react";
import { hasOverlay } from "../../../app/shell/hasOverlay";
import { isTyping } from "../../../app/shell/isTyping";
import { shortcutOf, type WorkbenchActions } from "./shortcuts";
import { useListFocus } from "./useListFocus";

/** Where Space and Enter press what has the focus. */
const PRESSED = "button, a[href], summary, input[type=checkbox], [role^=menuitem]";

export function useShortcuts(actions: WorkbenchActions): void {
  useListFocus();
  const latest = useRef(actions);
  useEffect(() => {
    latest.current = actions;
  });
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.defaultPrevented || isMeantElsewhere(event)) return;
      const found = shortcutOf(event);
      if (found === null) return;
      event.preventDefault();
      if (!event.repeat || isRepeatable(found.key)) found.shortcut.run(latest.current, found.key);
    };
    window.addEventListener("keydown", onKeyDown);
    window.addEventListener("mousedown", leaveFocus);
    return () => {
      window.removeEventListener("keydown", onKeyDown);
      window.removeEventListener("mousedown", leaveFocus);
    };
  }, []);
}

/** A button that was clicked does not get the focus: Enter after a click on Undo is to confirm, not to undo once more. */
function leaveFocus(event: MouseEvent): void {
  const isPressed = event.target instanceof Element && event.target.closest("button") !== null;
  if (isPressed && document.querySelector("dialog[open]") === null) event.preventDefault();
}

function isMeantElsewhere({ target, key }: KeyboardEvent): boolean {
  if (!(target instanceof Element)) return false;
  if (isTyping(target) || hasOverlay()) return true;
  return (key === " " || key === "Enter") && target.closest(PRESSED) !== null;
}

/** Keys that go on while they are held down. */
function isRepeatable(key: string): boolean {
  return ["[", "]", ",", ".", "ctrl+z", "ctrl+y", "ctrl+shift+z"].includes(key);
}
