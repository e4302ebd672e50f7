/** Clicks and touches on tiles: choose, toggle, ranges, open. */
import { type MouseEvent, type PointerEvent, useCallback, useEffect, useRef } from "react";

const LONG_PRESS_MS = 450;
/** A finger that moves further than this scrolls. */
const STILL_PX = 8;

export interface GridPointerActions {
  only(place: number): void;
  toggle(place: number): void;
  range(place: number, isAdding: boolean): void;
  open(place: number): void;
}

/** `isChoosing`: some are chosen already, so that on a touch screen a tap adds to them. */
export function useGridPointer(actions: GridPointerActions, isChoosing: boolean) {
  const press = useRef<{ timer: number; x: number; y: number } | null>(null);
  const isTouch = useRef(false);
  const wasLong = useRef(false);
  const endPress = useCallback(() => {
    if (press.current) window.clearTimeout(press.current.timer);
    press.current = null;
  }, []);
  useEffect(() => endPress, [endPress]);

  return {
    onPointerDown: (event: PointerEvent) => {
      isTouch.current = event.pointerType === "touch";
      wasLong.current = false;
      const place = placeOf(event);
      if (!isTouch.current || place === null) return;
      const timer = window.setTimeout(() => {
        wasLong.current = true;
        actions.toggle(place);
      }, LONG_PRESS_MS);
      press.current = { timer, x: event.clientX, y: event.clientY };
    },
    onPointerMove: (event: PointerEvent) => {
      const begun = press.current;
      if (begun && Math.hypot(event.clientX - begun.x, event.clientY - begun.y) > STILL_PX) endPress();
    },
    onPointerUp: endPress,
    onPointerCancel: endPress,
    onContextMenu: (event: MouseEvent) => {
      if (isTouch.current) event.preventDefault();
    },
    onClick: (event: MouseEvent) => {
      const place = placeOf(event);
      if (place === null || wasLong.current) return;
      const isTick = (event.target as Element).closest("[data-tick]") !== null;
      if (event.shiftKey) actions.range(place, event.ctrlKey || event.metaKey);
      else if (event.ctrlKey || event.metaKey || isTick || (isTouch.current && isChoosing))
        actions.toggle(place);
      else actions.only(place);
    },
    onDoubleClick: (event: MouseEvent) => {
      const place = placeOf(event);
      const isPlain = !event.shiftKey && !event.ctrlKey && !event.metaKey;
      if (place !== null && isPlain && (event.target as Element).closest("[data-tick]") === null)
        actions.open(place);
    },
  };
}

function placeOf(event: { target: EventTarget }): number | null {
  const place = (event.target as Element).closest<HTMLElement>("[data-place]")?.dataset.place;
  return place === undefined ? null : Number(place);
}
