/** Keeps the same shapes in view while rows change their size and number, and begins where the list was left. */
import { type RefObject, useEffect, useLayoutEffect, useRef } from "react";
import { type GridGeometry, scrollTopOf } from "./gridGeometry";

/** Returns the first place in view, as it is while the grid is shown. ratio : of the grid's scroll scale. */
export function useHeldPlace(
  scroller: RefObject<HTMLDivElement | null>,
  { columns, rowPx }: GridGeometry,
  ratio: number,
  isMeasured: boolean,
  begin: number,
): RefObject<number> {
  const place = useRef(begin);
  const scale = useRef(ratio);
  scale.current = ratio;
  /** Where this put the scrollbar: rounding it to a row is not scrolling. */
  const putAt = useRef<number | null>(null);
  useLayoutEffect(() => {
    const element = scroller.current;
    if (element === null || !isMeasured) return;
    element.scrollTop = scrollTopOf(Math.floor(place.current / columns), rowPx, scale.current);
    putAt.current = element.scrollTop;
  }, [scroller, columns, rowPx, isMeasured]);
  useEffect(() => {
    const element = scroller.current;
    if (element === null) return undefined;
    const onScroll = () => {
      if (element.scrollTop === putAt.current) return;
      putAt.current = null;
      place.current = Math.floor((element.scrollTop * scale.current) / rowPx) * columns;
    };
    element.addEventListener("scroll", onScroll, { passive: true });
    return () => element.removeEventListener("scroll", onScroll);
  }, [scroller, columns, rowPx]);
  return place;
}
