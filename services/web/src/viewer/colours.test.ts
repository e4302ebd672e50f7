import { describe, expect, it } from "vitest";
import { heatColour, patchTint, type Rgb, rgbOf } from "./colours";

const lightness = ([red, green, blue]: Rgb) => 0.2126 * red + 0.7152 * green + 0.0722 * blue;

describe("colours", () => {
  it("are read from hex", () => expect(rgbOf("#E69F00")).toEqual([230, 159, 0]));
  it("that are none are grey", () => expect(rgbOf("red")).toEqual([128, 128, 128]));

  it("of the heat map get lighter as values rise, also beyond 0 and 1", () => {
    const levels = [-1, 0, 0.25, 0.5, 0.75, 1, 2].map((value) => lightness(heatColour(value)));
    expect(levels).toEqual(levels.toSorted((a, b) => a - b));
  });

  it("of patches numbered one after the other differ", () => {
    const tints = Array.from({ length: 60 }, (_, patch) => patchTint(patch, [180, 185, 193]));
    for (const [place, tint] of tints.entries()) {
      const next = tints[place + 1];
      if (next !== undefined)
        expect(Math.hypot(...tint.map((v, axis) => v - (next[axis] as number)))).toBeGreaterThan(15);
    }
  });
});
