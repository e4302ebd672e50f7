import { describe, expect, it } from "vitest";
import type { ShapeRow } from "../rows/shapeRows";
import { aRow } from "../rows/testing";
import {
  chooseAll,
  chooseNone,
  chooseOnly,
  chooseRange,
  MAX_CHOSEN,
  NOTHING,
  refreshed,
  span,
  toggle,
} from "./selection";

const rows = (n: number, from = 1): ShapeRow[] => Array.from({ length: n }, (_, i) => aRow({ id: from + i }));
const ids = (selection: { chosen: ReadonlyMap<number, ShapeRow> }) => [...selection.chosen.keys()];

describe("selection", () => {
  it("a plain choice replaces what was chosen and begins ranges there", () => {
    const two = chooseOnly(chooseOnly(NOTHING, aRow({ id: 1 }), 0), aRow({ id: 5 }), 4);
    expect(ids(two)).toEqual([5]);
    expect(two.anchor).toBe(4);
  });

  it("toggling twice leaves things as they were", () => {
    const row = aRow({ id: 3 });
    expect(ids(toggle(toggle(NOTHING, row, 2), row, 2))).toEqual([]);
  });

  it("a range takes the place of what was chosen and keeps where it began", () => {
    const begun = chooseOnly(NOTHING, aRow({ id: 9 }), 2);
    const range = chooseRange(begun, rows(3), { cursor: 4, isAdding: false });
    expect(ids(range)).toEqual([1, 2, 3]);
    expect(range.anchor).toBe(2);
    expect(range.cursor).toBe(4);
  });

  it("a range that is added keeps what was chosen", () => {
    const begun = chooseOnly(NOTHING, aRow({ id: 9 }), 2);
    expect(ids(chooseRange(begun, rows(2), { cursor: 4, isAdding: true }))).toEqual([9, 1, 2]);
  });

  it("takes no more than an action does, and tells how many are beyond", () => {
    const range = chooseRange(NOTHING, rows(MAX_CHOSEN + 3), { cursor: 0, isAdding: false, nMore: 4 });
    expect(range.chosen.size).toBe(MAX_CHOSEN);
    expect(range.nBeyond).toBe(7);
  });

  it("all of a longer list tells how many are beyond", () => {
    expect(chooseAll(NOTHING, rows(10), 25).nBeyond).toBe(15);
  });

  it("none chosen leaves the keyboard where it is", () => {
    const at = chooseOnly(NOTHING, aRow({ id: 1 }), 7);
    expect(chooseNone(at)).toMatchObject({ cursor: 7, nBeyond: 0 });
  });

  it("rows as they are now take the place of those chosen, and only where they differ", () => {
    const row = aRow({ id: 1, state: "ready" });
    const held = chooseOnly(NOTHING, row, 0);
    expect(refreshed(held, [row, aRow({ id: 2 })])).toBe(held);
    expect(refreshed(held, [aRow({ id: 1, state: "confirmed" })]).chosen.get(1)?.state).toBe("confirmed");
  });
});

describe("span", () => {
  it.each([
    [3, 5, { first: 3, count: 3, nMore: 0 }],
    [5, 3, { first: 3, count: 3, nMore: 0 }],
    [4, 4, { first: 4, count: 1, nMore: 0 }],
    [0, 599, { first: 0, count: 500, nMore: 100 }],
    [599, 0, { first: 100, count: 500, nMore: 100 }],
  ])("from %i to %i", (from, to, expected) => {
    expect(span(from, to)).toEqual(expected);
  });
});
