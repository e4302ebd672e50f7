import { describe, expect, it } from "vitest";
import { type Sample, withSample } from "./history";
import type { Ops } from "./queries";

const ops = { stages: [{ stage: "mesh", per_min: 3 }], queue: { free: 5, held: 1 } } as unknown as Ops;

describe("the history of figures", () => {
  it("gets a sample", () => {
    expect(withSample([], ops, 100)).toEqual([{ atS: 100, perMin: { mesh: 3 }, free: 5, held: 1 }]);
  });

  it("passes over one that comes at once after another", () => {
    const history = withSample([], ops, 100);
    expect(withSample(history, ops, 102)).toBe(history);
  });

  it("forgets the oldest", () => {
    let history: readonly Sample[] = [];
    for (let n = 0; n < 1_100; n++) history = withSample(history, ops, n * 10);
    expect(history.length).toBe(1_080);
    expect(history[0]?.atS).toBe(200);
  });
});
