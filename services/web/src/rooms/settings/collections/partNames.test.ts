import { describe, expect, it } from "vitest";
import { partNamesOf } from "./partNames";

describe("names of parts", () => {
  it("stand one a line, in their order", () =>
    expect(partNamesOf("seat\nback\nleg")).toEqual(["seat", "back", "leg"]));
  it("lose blanks, empty lines and repetitions", () =>
    expect(partNamesOf(" seat \n\nseat\nback\r")).toEqual(["seat", "back"]));
});
