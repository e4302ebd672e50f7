/** Rows of the grid that are in view, by TanStack Virtual; of grids too long for browsers, through a shorter scrollbar. */
import {
  elementScroll,
  observeElementOffset,
  useVirtualizer,
  type VirtualItem,
} from "@tanstack/react-virtual";
import { type RefObject, useEffect, useLayoutEffect, useRef } from "react";
import { GAP_PX, type GridGeometry, scrollScale, scrollTopToShow } from "./gridGeometry";

const ROWS_AHEAD = 2;

export interface GridWindow {
  readonly rows: readonly VirtualItem[];
  /** Height of the element that scrolls. */
  readonly elementPx: number;
  /** Pixels of the grid that one of the scrollbar stands for. */
  readonly ratio: number;
  /** Where rows are drawn: an element inside it, which this moves along. */
  readonly stage: RefObject<HTMLDivElement | null>;
  readonly isScrolling: boolean;
  /** Brings a row into view, if it is not. */
  show(row: number): void;
}

export function useGridVirtualizer(
  scroller: RefObject<HTMLDivElement | null>,
  geometry: GridGeometry,
  viewportPx: number,
): GridWindow {
  const { elementPx, ratio } = scrollScale(geometry.contentPx, viewportPx);
  const scale = useRef(ratio);
  scale.current = ratio;
  const virtualizer = useVirtualizer<HTMLDivElement, HTMLDivElement>({
    count: geometry.nRows,
    getScrollElement: () => scroller.current,
    estimateSize: () => geometry.rowPx,
    overscan: ROWS_AHEAD,
    paddingStart: GAP_PX,
    observeElementOffset: (instance, callback) =>
      observeElementOffset(instance, (offset, isScrolling) => callback(offset * scale.current, isScrolling)),
    scrollToFn: (offset, options, instance) => elementScroll(offset / scale.current, options, instance),
  });
  // biome-ignore lint/correctness/useExhaustiveDependencies: heights of rows follow from the geometry alone
  useLayoutEffect(() => virtualizer.measure(), [geometry.rowPx, virtualizer]);

  const rows = virtualizer.getVirtualItems();
  const stage = useRef<HTMLDivElement>(null);
  useStagePosition(scroller, stage, rows[0]?.start ?? 0, ratio);
  useWheel(scroller, ratio);
  return {
    rows,
    elementPx,
    ratio,
    stage,
    isScrolling: virtualizer.isScrolling,
    // Not by the virtualizer, which knows the length of the element only and takes it for that of the grid.
    show: (row) => {
      const element = scroller.current;
      if (element === null) return;
      const view = { scrollTopPx: element.scrollTop, viewportPx, ratio };
      element.scrollTop = scrollTopToShow(row, geometry.rowPx, view);
    },
  };
}

/** Rows are placed from the first one drawn, so that no position in the page is beyond what browsers can hold. */
function useStagePosition(
  scroller: RefObject<HTMLDivElement | null>,
  stage: RefObject<HTMLDivElement | null>,
  startPx: number,
  ratio: number,
): void {
  useLayoutEffect(() => {
    const element = scroller.current;
    if (!element) return undefined;
    const place = () => {
      if (stage.current) {
        const top = startPx + element.scrollTop * (1 - ratio);
        stage.current.style.transform = `translateY(${top}px)`;
      }
    };
    place();
    if (ratio === 1) return undefined;
    element.addEventListener("scroll", place, { passive: true });
    return () => element.removeEventListener("scroll", place);
  }, [scroller, stage, startPx, ratio]);
}

/** A notch of the wheel moves the grid as far as anywhere, though the scrollbar runs faster than the grid. */
function useWheel(scroller: RefObject<HTMLDivElement | null>, ratio: number): void {
  useEffect(() => {
    const element = scroller.current;
    if (!element || ratio === 1) return undefined;
    const onWheel = (event: WheelEvent) => {
      if (event.ctrlKey || event.deltaMode !== WheelEvent.DOM_DELTA_PIXEL) return;
      event.preventDefault();
      element.scrollTop += event.deltaY / ratio;
    };
    element.addEventListener("wheel", onWheel, { passive: false });
    return () => element.removeEventListener("wheel", onWheel);
  }, [scroller, ratio]);
}
