// @vitest-environment jsdom
import { act, cleanup, renderHook, screen } from "@testing-library/react";
import { afterEach, beforeEach, describe, expect, it } from "vitest";
import { ToastProvider } from "../../../components";
import type { ShapeRow } from "../rows/shapeRows";
import type { RowList } from "../rows/tableQueries";
import { aRow } from "../rows/testing";
import type { ListReader } from "../rows/useListReader";
import { rememberPlace } from "../view/leftPlaces";
import { NO_FILTERS } from "../view/tableView";
import { useSelection } from "./useSelection";

const LIST: RowList = { collectionId: 1, filters: NO_FILTERS, order: null, descending: false, generation: 0 };
const READY: RowList = { ...LIST, filters: { ...NO_FILTERS, state: "ready" } };
const BY_NAME: RowList = { ...LIST, order: "name" };
const ROWS = Array.from({ length: 9 }, (_, place) => aRow({ id: place, state: "ready" }));
const at = (place: number) => ROWS[place] as ShapeRow;

/** A list that answers when `answer` is called. */
class SlowList implements ListReader {
  private readonly waiting: (() => void)[] = [];

  range(first: number, count: number) {
    return this.later(() => ROWS.slice(first, first + count));
  }

  firstOf(limit: number, isWanted: (row: ShapeRow) => boolean) {
    return this.later(() => {
      const rows = ROWS.filter(isWanted).slice(0, limit);
      return { rows, nPassed: ROWS.length - rows.length };
    });
  }

  answer = () => act(async () => this.waiting.splice(0).forEach((each) => void each()));

  private later<T>(made: () => T): Promise<T> {
    return new Promise((resolve) => this.waiting.push(() => resolve(made())));
  }
}

function selecting(begin = LIST) {
  const reader = new SlowList();
  const { result, rerender } = renderHook(({ list }) => useSelection(list, reader), {
    wrapper: ToastProvider,
    initialProps: { list: begin },
  });
  const ids = () => [...result.current.selection.chosen.keys()];
  return {
    state: () => result.current,
    show: (list: RowList) => rerender({ list }),
    answer: reader.answer,
    ids,
  };
}

beforeEach(() => sessionStorage.clear());
afterEach(cleanup);

describe("a range whose rows have to be read", () => {
  it("is chosen once they are", async () => {
    const { state, answer, ids } = selecting();
    act(() => state().only(at(1), 1));
    act(() => state().range(3, false));
    await answer();
    expect(ids()).toEqual([1, 2, 3]);
  });

  it("does not take the place of what was chosen meanwhile", async () => {
    const { state, answer, ids } = selecting();
    act(() => state().range(3, false));
    act(() => state().only(at(7), 7));
    await answer();
    expect(ids()).toEqual([7]);
  });

  it("does not come back once none was chosen", async () => {
    const { state, answer, ids } = selecting();
    act(() => state().range(3, false));
    act(() => state().none());
    await answer();
    expect(ids()).toEqual([]);
  });

  it.each([READY, BY_NAME])("does not land in another list", async (other) => {
    const { state, show, answer, ids } = selecting();
    act(() => state().range(3, false));
    show(other);
    await answer();
    expect(ids()).toEqual([]);
  });

  it("is the last of two, whichever is answered last", async () => {
    const { state, answer, ids } = selecting();
    act(() => state().range(8, false));
    act(() => state().range(1, false));
    await answer();
    expect(ids()).toEqual([0, 1]);
  });
});

describe("another list", () => {
  it("of other shapes begins with nothing chosen", () => {
    const { state, show, ids } = selecting();
    act(() => state().only(at(5), 5));
    show(READY);
    expect(ids()).toEqual([]);
  });

  it("of the same shapes in another order keeps them, but no range begins at a place of the old one", async () => {
    const { state, show, answer, ids } = selecting();
    act(() => state().only(at(5), 5));
    show(BY_NAME);
    expect(ids()).toEqual([5]);
    act(() => state().range(1, false));
    await answer();
    expect(ids()).toEqual([0, 1]);
  });

  it("has the keyboard where it was left", () => {
    rememberPlace(BY_NAME, { first: 0, cursor: 4 });
    const { state, show } = selecting();
    show(BY_NAME);
    expect(state().selection.cursor).toBe(4);
  });
});

describe("all", () => {
  it("of a state are those that were not acted on", async () => {
    const { state, answer, ids } = selecting(READY);
    act(() => state().setDone([0, 1, 2]));
    act(() => state().all(ROWS.length));
    await answer();
    expect(ids()).toEqual([3, 4, 5, 6, 7, 8]);
    expect(state().selection.nBeyond).toBe(0);
  });

  it("says so where none is left", async () => {
    const { state, answer, ids } = selecting(READY);
    act(() => state().setDone(ROWS.map((row) => row.id)));
    act(() => state().all(ROWS.length));
    await answer();
    expect(ids()).toEqual([]);
    expect(screen.getByText(/were acted on already/)).toBeTruthy();
  });

  it("of a list of any state are all of them", async () => {
    const { state, answer, ids } = selecting(LIST);
    act(() => state().setDone([0, 1, 2]));
    act(() => state().all(ROWS.length));
    await answer();
    expect(ids()).toHaveLength(ROWS.length);
  });
});
