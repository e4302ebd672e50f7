/** The shape in the middle of the map, for people who pick with keys. */
import { type FocusEvent, useEffect, useState } from "react";
import type { MapView } from "./MapView";
import { aimedAt } from "./useMapGestures";

/** isAiming : keys have brought the focus to the map. aimed : a place, or -1. The rest goes to the canvas. */
export function useAim(view: MapView) {
  const [isAiming, setAiming] = useState(false);
  const [aimed, setAimed] = useState(-1);
  useEffect(() => {
    if (!isAiming) return undefined;
    const look = () => setAimed(aimedAt(view));
    look();
    view.onLook = look;
    return () => {
      view.onLook = () => undefined;
      setAimed(-1);
    };
  }, [view, isAiming]);
  return {
    isAiming,
    aimed,
    onFocus: (event: FocusEvent<HTMLElement>) => setAiming(event.currentTarget.matches(":focus-visible")),
    onBlur: () => setAiming(false),
  };
}
