// @vitest-environment jsdom
import { expect, it } from "vitest";
import type { RowList } from "../rows/tableQueries";
import { leftPlace, rememberPlace } from "./leftPlaces";
import { NO_FILTERS } from "./tableView";

const LIST: RowList = { collectionId: 1, filters: NO_FILTERS, order: null, descending: false, generation: 0 };

it("is where the list was left, also after it was read anew", () => {
  rememberPlace(LIST, { first: 240, cursor: 251 });
  expect(leftPlace({ ...LIST, generation: 1 })).toEqual({ first: 240, cursor: 251 });
});

it("is the beginning of a list that is new", () => {
  rememberPlace(LIST, { first: 240, cursor: 251 });
  for (const other of [{ collectionId: 2 }, { descending: true }, { filters: { ...NO_FILTERS, part: 1 } }])
    expect(leftPlace({ ...LIST, ...other })).toEqual({ first: 0, cursor: 0 });
});
