import { describe, expect, it } from "vitest";
import { aRow } from "../rows/testing";
import { acceptable, suggestedRechecks, versionsWords } from "./acceptance";

describe("acceptable", () => {
  const rows = [
    aRow({ id: 1, state: "ready", predicted_version: 2, refined_version: 2 }),
    aRow({ id: 2, state: "confirmed", predicted_version: 2, refined_version: 2 }),
    aRow({ id: 3, state: "ready", predicted_version: 2 }),
    aRow({ id: 4, state: "ready" }),
  ];

  it("are shapes with such labels that no person has labelled", () => {
    expect(acceptable(rows, "refined").map((row) => row.id)).toEqual([1]);
    expect(acceptable(rows, "predicted").map((row) => row.id)).toEqual([1, 3]);
  });
});

describe("suggestedRechecks", () => {
  it.each([
    [0, 0],
    [1, 0],
    [2, 1],
    [100, 5],
    [500, 25],
  ])("of %i are %i", (n, expected) => expect(suggestedRechecks(n)).toBe(expected));
});

describe("versionsWords", () => {
  it("names each model once, in order", () => {
    const rows = [3, 1, 3].map((refined_version) => aRow({ refined_version }));
    expect(versionsWords(rows, "refined")).toBe("models 1 and 3");
    expect(versionsWords([aRow({ predicted_version: 4 })], "predicted")).toBe("model 4");
    expect(versionsWords([], "predicted")).toBe("");
  });
});
