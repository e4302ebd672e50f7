import { describe, expect, it } from "vitest";
import { asTree, draftOf, nameError, newDraft, possibleParents } from "./partDraft";
import type { Part } from "./partRequests";

const part = (id: number, name: string, parent_id: number | null = null): Part => ({
  id,
  name,
  colour: "#0072B2",
  gloss: "",
  parent_id,
});
const PARTS = [part(1, "wing"), part(2, "flap", 1), part(3, "body"), part(4, "hinge", 2)];

describe("nameError", () => {
  const draft = newDraft(PARTS);
  it.each([
    ["", "Give the part a name."],
    ["  ", "Give the part a name."],
    ["Wing", "There is a part wing already."],
    ["x".repeat(65), "A name has at most 64 letters."],
    ["tail", null],
  ])("of %j", (name, error) => {
    expect(nameError({ ...draft, name }, PARTS)).toBe(error);
  });
});

describe("newDraft", () => {
  it("has a colour of its own", () => {
    expect(newDraft(PARTS).colour.toLowerCase()).not.toBe("#0072b2");
  });
});

describe("draftOf", () => {
  it("begins with what is on record", () => {
    expect(draftOf(part(2, "flap", 1))).toEqual({ name: "flap", colour: "#0072B2", gloss: "", parentId: 1 });
  });
});

describe("possibleParents", () => {
  it("are neither the part itself nor those below it", () => {
    expect(possibleParents(PARTS, 1).map((each) => each.id)).toEqual([3]);
    expect(possibleParents(PARTS, 4).map((each) => each.id)).toEqual([1, 2, 3]);
    expect(possibleParents(PARTS, null)).toHaveLength(4);
  });
});

describe("asTree", () => {
  it("puts children after their parents", () => {
    expect(asTree(PARTS).map(({ part: { id }, depth }) => [id, depth])).toEqual([
      [1, 0],
      [2, 1],
      [4, 2],
      [3, 0],
    ]);
  });
});
