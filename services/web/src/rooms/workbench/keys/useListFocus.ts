/**
 * A list that was clicked gives the focus up with the choice: a letter is to be a key again, not to choose another of the
 * list. Who came to it by Tab goes on choosing by keys.
 */
import { useEffect } from "react";
import { hasOverlay } from "../../../app/shell/hasOverlay";

export function useListFocus(): void {
  useEffect(() => {
    let clicked: EventTarget | null = null; // `:focus-visible` does not tell: a list that is open has it either way
    const onMouseDown = ({ target }: MouseEvent) => {
      clicked = target;
    };
    const onKeyDown = ({ key }: KeyboardEvent) => {
      if (key === "Tab") clicked = null;
    };
    const onChange = ({ target }: Event) => {
      if (target instanceof HTMLSelectElement && target === clicked && !hasOverlay()) target.blur();
    };
    window.addEventListener("mousedown", onMouseDown);
    window.addEventListener("keydown", onKeyDown);
    window.addEventListener("change", onChange);
    return () => {
      window.removeEventListener("mousedown", onMouseDown);
      window.removeEventListener("keydown", onKeyDown);
      window.removeEventListener("change", onChange);
    };
  }, []);
}
