import { describe, expect, it } from "vitest";
import { effortOf } from "./effort";

/** Strokes so many seconds after the shape was opened. */
const strokesAt = (...seconds: number[]) => seconds.map((s) => ({ at: new Date(s * 1000).toISOString() }));
const OPENED = new Date(0).toISOString();

describe("the effort of a shape", () => {
  it("is nothing before the first stroke", () =>
    expect(effortOf([], OPENED)).toEqual({ activeMs: 0, nClicks: 0 }));

  it("counts the look before the first stroke, and each gap after it", () =>
    expect(effortOf(strokesAt(5, 12, 20.5), OPENED)).toEqual({ activeMs: 20_500, nClicks: 3 }));

  it("leaves out pauses longer than half a minute, and counts one of just so long", () => {
    expect(effortOf(strokesAt(31, 61, 91.1), OPENED).activeMs).toBe(30_000);
  });

  it("is never less for a clock that is behind the service\u2019s", () =>
    expect(effortOf(strokesAt(10, 14), new Date(60_000).toISOString()).activeMs).toBe(4_000));

  it("does not depend on the order in which strokes came", () =>
    expect(effortOf(strokesAt(9, 2, 4), OPENED)).toEqual(effortOf(strokesAt(2, 4, 9), OPENED)));
});
