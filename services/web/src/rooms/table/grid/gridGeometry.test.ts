import { describe, expect, it } from "vitest";
import { GAP_PX, gridGeometry, placeAfter, scrollScale } from "./gridGeometry";

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
