import { describe, expect, it } from "vitest";
import {
  BAR_PX,
  GAP_PX,
  gridGeometry,
  placeAfter,
  scrollScale,
  scrollTopOf,
  scrollTopToShow,
} from "./gridGeometry";

describe("gridGeometry", () => {
  it.each([320, 768, 1280, 2560])("tiles and gaps fill a width of %i without overflowing it", (width) => {
    for (const size of ["s", "m", "l"] as const) {
      const { columns, tilePx } = gridGeometry(width, size, 1_000);
      const used = columns * tilePx + (columns + 1) * GAP_PX;
      expect(used).toBeLessThanOrEqual(width);
      expect(width - used).toBeLessThan(columns + 1);
    }
  });

  it("has a row for a last tile that stands alone", () => {
    const { columns } = gridGeometry(1280, "m", 1);
    expect(gridGeometry(1280, "m", columns + 1).nRows).toBe(2);
    expect(gridGeometry(1280, "m", 0).nRows).toBe(0);
  });

  it("keeps one column where there is no room for one", () => {
    expect(gridGeometry(0, "l", 5).columns).toBe(1);
  });
});

describe("scrollScale", () => {
  it("is one to one for what browsers can hold", () => {
    expect(scrollScale(1_000_000, 700)).toEqual({ elementPx: 1_000_000, ratio: 1 });
  });

  it("ends at the last row however long the grid is", () => {
    const { elementPx, ratio } = scrollScale(60_000_000, 700);
    expect((elementPx - 700) * ratio).toBeCloseTo(60_000_000 - 700);
  });
});

describe("scrollTopToShow", () => {
  const RATIO = 1.5;
  const ROW_PX = 260;
  const N_ROWS = 69_000;
  const view = { viewportPx: 700, ratio: RATIO };
  const contentPx = N_ROWS * ROW_PX + GAP_PX + BAR_PX;
  /** Of the grid, what is in view from a place of the scrollbar on. */
  const shown = (scrollTopPx: number) =>
    [scrollTopPx * RATIO, scrollTopPx * RATIO + view.viewportPx] as const;

  it.each([0, 1, 40_000, N_ROWS - 1])("brings all of row %i into view, in pixels of the scrollbar", (row) => {
    for (const scrollTopPx of [0, 3_000_000, (contentPx - view.viewportPx) / RATIO]) {
      const found = scrollTopToShow(row, ROW_PX, { ...view, scrollTopPx });
      const [begin, end] = shown(found);
      expect(row * ROW_PX).toBeGreaterThanOrEqual(begin - 1e-6);
      expect(GAP_PX + (row + 1) * ROW_PX).toBeLessThanOrEqual(end - BAR_PX + 1e-6);
      expect(scrollTopToShow(row, ROW_PX, { ...view, scrollTopPx: found })).toBeCloseTo(found);
    }
  });

  it("goes to the very end for the last row", () => {
    const found = scrollTopToShow(N_ROWS - 1, ROW_PX, { ...view, scrollTopPx: 0 });
    expect(found).toBeCloseTo((contentPx - view.viewportPx) / RATIO);
  });

  it("begins a row in view that is taller than the view", () => {
    expect(scrollTopToShow(3, 260, { scrollTopPx: 0, viewportPx: 200, ratio: 1 })).toBe(780);
    expect(scrollTopToShow(3, 260, { scrollTopPx: 900, viewportPx: 200, ratio: 1 })).toBe(780);
  });

  it("brings a row to the top where it is first", () => {
    expect(scrollTopOf(9, ROW_PX, RATIO) * RATIO).toBeCloseTo(9 * ROW_PX);
  });
});

describe("placeAfter", () => {
  const grid = { columns: 4, nShapes: 10, rowsInView: 2, toEnd: false };
  it.each([
    ["ArrowRight", 9, 9],
    ["ArrowRight", 3, 4],
    ["ArrowLeft", 0, 0],
    ["ArrowDown", 1, 5],
    ["ArrowDown", 7, 9],
    ["ArrowDown", 8, 8],
    ["ArrowUp", 5, 1],
    ["ArrowUp", 1, 1],
    ["PageDown", 1, 9],
    ["PageDown", 2, 6],
    ["PageUp", 9, 1],
    ["PageUp", 6, 2],
    ["Home", 6, 4],
    ["End", 4, 7],
    ["End", 8, 9],
  ])("%s from %i leads to %i", (key, from, to) => {
    expect(placeAfter(key, from, grid)).toBe(to);
  });

  it("Ctrl goes to either end", () => {
    expect(placeAfter("Home", 6, { ...grid, toEnd: true })).toBe(0);
    expect(placeAfter("End", 2, { ...grid, toEnd: true })).toBe(9);
  });

  it("does not move for other keys", () => {
    expect(placeAfter("a", 2, grid)).toBeNull();
  });
});
