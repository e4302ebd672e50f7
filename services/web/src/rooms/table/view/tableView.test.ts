import { describe, expect, it } from "vitest";
import {
  countFilters,
  DEFAULT_VIEW,
  NO_FILTERS,
  searchedName,
  searchOf,
  type TableView,
  viewOf,
} from "./tableView";

const FULL: TableView = {
  shown: "refined",
  order: "entropy",
  descending: true,
  filters: { name: "arm chair/é&1", state: "ready", part: 2, cluster: 0, author: 7, failed: "remesh" },
  size: "l",
  panel: "map",
};

describe("viewOf", () => {
  it("reads back what searchOf wrote", () => {
    expect(viewOf(searchOf(FULL))).toEqual(FULL);
  });

  it("is the default without anything", () => {
    expect(viewOf("")).toEqual(DEFAULT_VIEW);
  });

  it.each([
    "show=all",
    "state=gone",
    "part=-1",
    "part=1e3",
    "order=A;B",
    "size=xl",
    "panel=x",
    "failed=a b",
    "dir=up",
  ])("leaves what it cannot mean at its default: %s", (search) => {
    expect(viewOf(search)).toEqual(DEFAULT_VIEW);
  });

  it("takes cluster 0 as a cluster", () => {
    expect(viewOf("cluster=0").filters.cluster).toBe(0);
  });
});

describe("searchedName", () => {
  it.each([
    ["", null],
    ["  ", null],
    [" a.off ", "a.off"],
    ["a\0b", "ab"],
    ["n".repeat(201), "n".repeat(200)],
  ])("of %j is %j", (text, name) => expect(searchedName(text)).toBe(name));
});

describe("searchOf", () => {
  it("says nothing of the default", () => {
    expect(searchOf(DEFAULT_VIEW)).toBe("");
  });
});

describe("countFilters", () => {
  it("counts those that are set", () => {
    expect(countFilters({ ...NO_FILTERS, cluster: 0, part: 3 })).toBe(2);
    expect(countFilters(NO_FILTERS)).toBe(0);
  });
});
