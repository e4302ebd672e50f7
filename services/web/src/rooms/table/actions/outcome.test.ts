import { describe, expect, it } from "vitest";
import { askForEach, grouped, outcomeWords } from "./outcome";

describe("askForEach", () => {
  it("asks for every shape, and goes on past those that are refused", async () => {
    const outcome = await askForEach([1, 2, 3, 4, 5, 6], async (id) => {
      if (id % 3 === 0) throw new Error(`shape ${id} has no labels`);
    });
    expect([...outcome.done].sort()).toEqual([1, 2, 4, 5]);
    expect(outcome.refused.map((each) => each.shapeId).sort()).toEqual([3, 6]);
  });

  it("has few requests under way at a time, and tells how many are through", async () => {
    let underWay = 0;
    let most = 0;
    const told: number[] = [];
    await askForEach(
      Array.from({ length: 20 }, (_, i) => i),
      async () => {
        underWay += 1;
        most = Math.max(most, underWay);
        await Promise.resolve();
        underWay -= 1;
      },
      (n) => told.push(n),
    );
    expect(most).toBe(4);
    expect(told.at(-1)).toBe(20);
  });

  it("of nothing is nothing", async () => {
    expect(await askForEach([], () => Promise.reject(new Error()))).toEqual({ done: [], refused: [] });
  });
});

describe("grouped", () => {
  it("puts refusals together that differ by the shape's number only", () => {
    const refused = [
      { shapeId: 1, why: "shape 1 has no labels to send back" },
      { shapeId: 12, why: "shape 12 has no labels to send back" },
      { shapeId: 3, why: "those of shape 3 were already; await better ones" },
    ];
    expect(grouped(refused, (id) => `${id}.off`)).toEqual([
      ["this shape has no labels to send back", ["1.off", "12.off"]],
      ["those of this shape were already; await better ones", ["3.off"]],
    ]);
  });
});

describe("outcomeWords", () => {
  it("counts", () => {
    expect(outcomeWords(1, "sent back")).toBe("1 shape sent back");
    expect(outcomeWords(1200, "sent back")).toBe("1,200 shapes sent back");
  });
});
