import { describe, expect, it } from "vitest";
import { nextShown, SHOWN_CHOICES, whyMissing } from "./shown";
import { inViews, nextCount, ONE_VIEW, shownAt, withShown } from "./views";

describe("views", () => {
  it("are one to four, and one again", () => {
    expect([1, 2, 3, 4].map((count) => nextCount(count as 1 | 2 | 3 | 4))).toEqual([2, 3, 4, 1]);
  });

  it("show the draft until they are told otherwise, each by itself", () => {
    const views = { ...ONE_VIEW, shown: withShown(ONE_VIEW, 2, "predicted") };
    expect([0, 1, 2, 3].map((place) => shownAt(views, place))).toEqual([
      "draft",
      "draft",
      "predicted",
      "draft",
    ]);
    expect(shownAt({ ...views, shown: withShown(views, 2, "draft") }, 2)).toBe("draft");
  });

  it("have a shape each, and room for more", () => {
    expect(inViews(["a", "b"], "a", 3)).toEqual(["a", "b", null]);
  });

  it("have the shape in hand in one of them, though there are more shapes than views", () => {
    expect(inViews(["a", "b", "c"], "b", 2)).toEqual(["a", "b"]);
    expect(inViews(["a", "b", "c"], "c", 2)).toEqual(["a", "c"]);
  });

  it("pass through all that can be shown, back to the draft", () => {
    const seen = [nextShown("draft")];
    while (seen.at(-1) !== "draft") seen.push(nextShown(seen.at(-1) ?? "draft"));
    expect(new Set(seen).size).toBe(SHOWN_CHOICES.length);
  });

  it("say what a shape does not have to show", () => {
    expect(whyMissing("draft", false, false)).toBeNull();
    expect(whyMissing("confirmed", true, false)).toContain("confirmed");
    expect(whyMissing("uncertainty", false, true)).toContain("model");
    expect(whyMissing("refined", true, false)).toBeNull();
  });
});
