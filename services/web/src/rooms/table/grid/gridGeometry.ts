/** Where tiles of the grid lie: columns that fill the width, rows of one height, and a scrollbar that stays in bounds. */
import type { TileSize } from "../view/tableView";

/** Between tiles, and around them. */
export const GAP_PX = 10;
const LEAST_TILE_PX: Readonly<Record<TileSize, number>> = { s: 96, m: 144, l: 216 };
const CAPTION_PX: Readonly<Record<TileSize, number>> = { s: 24, m: 46, l: 46 };

/** Left free below the last row, where the bar of what is selected floats. */
export const BAR_PX = 64;

/** Browsers cut elements off beyond some 17 to 33 million pixels; past this, the scrollbar runs faster than the page. */
const LONGEST_PX = 12_000_000;

export interface GridGeometry {
  readonly columns: number;
  readonly tilePx: number;
  readonly rowPx: number;
  readonly nRows: number;
  /** Of all rows, as if there were no bounds. */
  readonly contentPx: number;
}

export function gridGeometry(widthPx: number, size: TileSize, nShapes: number): GridGeometry {
  const inner = Math.max(widthPx - 2 * GAP_PX, LEAST_TILE_PX[size]);
  const columns = Math.max(1, Math.floor((inner + GAP_PX) / (LEAST_TILE_PX[size] + GAP_PX)));
  const tilePx = Math.floor((inner - (columns - 1) * GAP_PX) / columns);
  const rowPx = tilePx + CAPTION_PX[size] + GAP_PX;
  const nRows = Math.ceil(nShapes / columns);
  return { columns, tilePx, rowPx, nRows, contentPx: nRows * rowPx + GAP_PX + BAR_PX };
}

/** The element's height, and how many pixels of the grid one of the scrollbar stands for. */
export interface ScrollScale {
  readonly elementPx: number;
  readonly ratio: number;
}

export function scrollScale(contentPx: number, viewportPx: number): ScrollScale {
  if (contentPx <= LONGEST_PX || viewportPx >= LONGEST_PX) return { elementPx: contentPx, ratio: 1 };
  return { elementPx: LONGEST_PX, ratio: (contentPx - viewportPx) / (LONGEST_PX - viewportPx) };
}

/** What of the grid is in view. ratio : of its scroll scale. */
export interface GridView {
  readonly scrollTopPx: number;
  readonly viewportPx: number;
  readonly ratio: number;
}

/** Where the scrollbar stands when a row is the first in view. */
export function scrollTopOf(row: number, rowPx: number, ratio: number): number {
  return (row * rowPx) / ratio;
}

/** Where the scrollbar stands when all of a row is in view, clear of the bar at the bottom; as it is where that is so. */
export function scrollTopToShow(row: number, rowPx: number, view: GridView): number {
  const { scrollTopPx, viewportPx, ratio } = view;
  const shownPx = scrollTopPx * ratio;
  const firstPx = row * rowPx;
  const lastPx = firstPx + GAP_PX + rowPx + BAR_PX - viewportPx;
  const isTooTall = lastPx > firstPx; // it begins in view
  return (isTooTall ? firstPx : Math.min(firstPx, Math.max(lastPx, shownPx))) / ratio;
}

/** The place that a key leads to from `place`; null if the key does not move. */
export function placeAfter(
  key: string,
  place: number,
  grid: { columns: number; nShapes: number; rowsInView: number; toEnd: boolean },
): number | null {
  const { columns, nShapes } = grid;
  const last = nShapes - 1;
  const inColumn = (rows: number) => {
    const next = place + rows * columns;
    if (next < 0) return place % columns;
    return next > last
      ? Math.max(place, Math.min(last, next - Math.ceil((next - last) / columns) * columns))
      : next;
  };
  switch (key) {
    case "ArrowRight":
      return Math.min(last, place + 1);
    case "ArrowLeft":
      return Math.max(0, place - 1);
    case "ArrowDown":
      return place + columns > last && Math.floor(place / columns) < Math.floor(last / columns)
        ? last
        : inColumn(1);
    case "ArrowUp":
      return place - columns < 0 ? place : place - columns;
    case "PageDown":
      return inColumn(grid.rowsInView);
    case "PageUp":
      return inColumn(-grid.rowsInView);
    case "Home":
      return grid.toEnd ? 0 : place - (place % columns);
    case "End":
      return grid.toEnd ? last : Math.min(last, place - (place % columns) + columns - 1);
    default:
      return null;
  }
}
