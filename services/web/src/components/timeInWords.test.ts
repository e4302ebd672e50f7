import { describe, expect, it } from "vitest";
import { ageInWords, durationInWords } from "./timeInWords";

describe("durations in words", () => {
  it.each([
    [0.4, "under 1 s"],
    [1, "1 s"],
    [59.9, "59 s"],
    [60, "1 min"],
    [3599, "59 min"],
    [3600, "1 h"],
    [12_000, "3 h 20 min"],
    [86_400, "1 day"],
    [432_000, "5 days"],
  ])("%d s are %s", (seconds, words) => {
    expect(durationInWords(seconds)).toBe(words);
  });
});

describe("ages in words", () => {
  it("looks back", () => expect(ageInWords(0, 180_000)).toBe("3 min ago"));
  it("looks ahead", () => expect(ageInWords(7_200_000, 0)).toBe("in 2 h"));
  it("does not count moments", () => expect(ageInWords(1_000, 0)).toBe("just now"));
});
