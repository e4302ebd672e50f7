import { describe, expect, it } from "vitest";
import {
  isReordered,
  nameOf,
  PAGE_ROWS,
  pagesOf,
  patched,
  pictureOf,
  renewed,
  shownOf,
  shownVersion,
} from "./shapeRows";
import { aPage, aRow } from "./testing";

describe("pagesOf", () => {
  it.each([
    [0, 0, [0]],
    [0, PAGE_ROWS - 1, [0]],
    [PAGE_ROWS - 1, PAGE_ROWS, [0, 1]],
    [5, 4, []],
  ])("of places %i to %i", (first, last, expected) => {
    expect(pagesOf(first, last)).toEqual(expected);
  });
});

describe("a page read anew", () => {
  const a = aRow({ id: 1, rank: 0 });
  const b = aRow({ id: 2, rank: 1 });

  it("shows what changed at the places where shapes were", () => {
    const fresh = aPage([aRow({ id: 2, rank: 0 }), aRow({ id: 1, rank: 1, state: "confirmed" })]);
    const shown = renewed(aPage([a, b]), fresh);
    expect(shown.items.map((row) => [row.id, row.state, row.rank])).toEqual([
      [1, "confirmed", 0],
      [2, "ready", 1],
    ]);
  });

  it("keeps rows that did not change, and those that are no longer in it", () => {
    const shown = renewed(aPage([a, b]), aPage([aRow({ id: 1, rank: 7 })]));
    expect(shown.items[0]).toBe(a);
    expect(shown.items[1]).toBe(b);
  });

  it("fills a list that was empty", () => {
    expect(renewed(aPage([]), aPage([a, b]))).toEqual(aPage([a, b]));
  });

  it("is in another order if any shape has another place, or there are more or fewer", () => {
    expect(isReordered(aPage([a, b]), aPage([b, a]))).toBe(true);
    expect(isReordered(aPage([a, b]), aPage([a]))).toBe(true);
    expect(isReordered(aPage([a], 1), aPage([a], 2))).toBe(true);
    expect(isReordered(aPage([a, b]), aPage([{ ...a, state: "review" }, b]))).toBe(false);
  });
});

describe("patched", () => {
  it("changes the one shape, and leaves pages without it as they are", () => {
    const page = aPage([aRow({ id: 1 }), aRow({ id: 2 })]);
    expect(patched(page, 2, { state: "confirmed" }).items.map((row) => row.state)).toEqual([
      "ready",
      "confirmed",
    ]);
    expect(patched(page, 3, { state: "confirmed" })).toBe(page);
  });
});

describe("labels shown", () => {
  const all = aRow({ has_confirmed: true, revision_id: 4, refined_version: 2, predicted_version: 3 });

  it("are the best there are: a person's before refined before predicted", () => {
    expect(shownOf(all, "best")).toBe("confirmed");
    expect(shownOf({ ...all, has_confirmed: false }, "best")).toBe("refined");
    expect(shownOf(aRow({ predicted_version: 3 }), "best")).toBe("predicted");
    expect(shownOf(aRow(), "best")).toBeNull();
  });

  it("are those asked for, or none", () => {
    expect(shownOf(all, "predicted")).toBe("predicted");
    expect(shownOf(aRow({ predicted_version: 3 }), "confirmed")).toBeNull();
  });

  it("say which model made them, and none where a person did", () => {
    expect(shownVersion(all, "refined")).toBe(2);
    expect(shownVersion(all, "best")).toBeNull();
  });

  it("change the picture's address with what they are", () => {
    const before = pictureOf(aRow({ refined_version: 1 }), "refined", "1");
    expect(before).toContain("segmentation=refined");
    expect(pictureOf(aRow({ refined_version: 2 }), "refined", "1")).not.toBe(before);
    expect(pictureOf(aRow({ refined_version: 1 }), "refined", "2")).not.toBe(before);
    expect(pictureOf(aRow({ mesh_hash: null }), "best", "1")).toBeNull();
    expect(pictureOf(aRow(), "best", "1")).not.toContain("segmentation");
  });
});

describe("nameOf", () => {
  it("parts the folder from the name", () => {
    expect(nameOf("chairs/old/a.off")).toEqual({ folder: "chairs/old/", name: "a.off" });
    expect(nameOf("a.off")).toEqual({ folder: "", name: "a.off" });
  });
});
