import { describe, expect, it } from "vitest";
import {
  colourWarning,
  contrast,
  difference,
  nextColour,
  rgbOf,
  SIGHTS,
  SUGGESTED_COLOURS,
} from "./contrast";

describe("contrast", () => {
  it("is 21 of black on white and 1 of a colour on itself, either way round", () => {
    expect(contrast("#000000", "#ffffff")).toBeCloseTo(21);
    expect(contrast("#ffffff", "#000000")).toBeCloseTo(21);
    expect(contrast("#336699", "#336699")).toBe(1);
  });
});

describe("difference", () => {
  it("is that of the standard's worked values", () => {
    // L* of white is 100, of black 0; mid grey #777777 is L* 50.03.
    expect(difference("#ffffff", "#000000")).toBeCloseTo(100, 0);
    expect(difference("#777777", "#000000")).toBeCloseTo(50.03, 0);
  });

  it("shrinks between red and green for those who do not tell them apart, grey staying grey", () => {
    expect(difference("#c04040", "#608000", "deuteranopia")).toBeLessThan(
      difference("#c04040", "#608000") / 2,
    );
    for (const sight of SIGHTS) expect(difference("#808080", "#404040", sight)).toBeGreaterThan(20);
  });
});

describe("colourWarning", () => {
  it.each([
    ["#0072b2", "The same colour as wing."],
    ["#0a78b5", "Hard to tell from wing."],
    ["#b4b9c1", "Looks like faces without a label."],
    ["#202329", "Hard to see on the background in one of the schemes."],
  ])("of %s", (colour, words) => {
    expect(colourWarning(colour, new Map([["wing", "#0072B2"]]))).toBe(words);
  });

  it("tells what only some people cannot tell apart", () => {
    expect(colourWarning("#d04a3c", new Map([["leg", "#8a7d2a"]]))).toMatch(/with (protanopia|deuteranopia)/);
  });

  it("has none for colours that are apart", () => {
    expect(colourWarning("#D55E00", new Map([["wing", "#0072B2"]]))).toBeNull();
  });
});

describe("nextColour", () => {
  it("is one that is not warned of, as long as there are any", () => {
    const taken: string[] = [];
    for (let i = 0; i < 6; i++) {
      const next = nextColour(taken);
      expect(colourWarning(next, new Map(taken.map((colour, k) => [`${k}`, colour])))).toBeNull();
      taken.push(next);
    }
  });

  it("is still one when all are taken", () => {
    expect(SUGGESTED_COLOURS).toContain(nextColour(SUGGESTED_COLOURS));
  });
});

describe("rgbOf", () => {
  it("reads a colour", () => expect(rgbOf("#0A80ff")).toEqual([10, 128, 255]));
});
