import { describe, expect, it } from "vitest";
import { cornerBeside } from "./placement";

const ROOM = { width: 1000, height: 600 };
const SIZE = { width: 200, height: 100 };

describe("where a popover goes", () => {
  it("is below its anchor, their starts in line", () => {
    expect(cornerBeside(SIZE, { left: 100, top: 50, width: 80, height: 30 }, ROOM, "start")).toEqual({
      left: 100,
      top: 86,
    });
  });

  it("may have the ends in line", () => {
    expect(cornerBeside(SIZE, { left: 400, top: 50, width: 80, height: 30 }, ROOM, "end").left).toBe(280);
  });

  it("is above where there is no room below", () => {
    expect(cornerBeside(SIZE, { left: 100, top: 540, width: 80, height: 30 }, ROOM, "start").top).toBe(434);
  });

  it("stays within the window", () => {
    expect(cornerBeside(SIZE, { left: 950, top: 50, width: 40, height: 30 }, ROOM, "centre").left).toBe(792);
  });

  it("begins at the margin where it is wider than the window", () => {
    expect(
      cornerBeside({ width: 2000, height: 10 }, { left: 0, top: 0, width: 1, height: 1 }, ROOM, "start").left,
    ).toBe(8);
  });
});
