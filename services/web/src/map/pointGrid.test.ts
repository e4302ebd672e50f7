import { describe, expect, it } from "vitest";
import { isInside, type Place, pointsInside } from "./lasso";
import { PointGrid } from "./pointGrid";
import { somePoints } from "./testing";

/** The same numbers every time (mulberry32). */
function drawn(seed: number): () => number {
  let a = seed;
  return () => {
    a = (a + 0x6d2b79f5) | 0;
    let t = Math.imul(a ^ (a >>> 15), 1 | a);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

const random = drawn(7);
const N = 3_000;
const points = somePoints(
  Array.from({ length: N }, () => random() * 10),
  Array.from({ length: N }, () => random() * 4 - 2),
);
const grid = new PointGrid(points);

describe("PointGrid", () => {
  it("finds the point that a look at all of them finds", () => {
    for (let k = 0; k < 200; k++) {
      const [x, y, radius] = [random() * 12 - 1, random() * 6 - 3, random()];
      let best = -1;
      let least = radius * radius;
      for (let i = 0; i < N; i++) {
        const distance = ((points.x[i] ?? 0) - x) ** 2 + ((points.y[i] ?? 0) - y) ** 2;
        if (distance <= least) [best, least] = [i, distance];
      }
      expect(grid.nearest(x, y, radius)).toBe(best);
    }
  });

  it("has none where there are no points, or all are at one place", () => {
    expect(new PointGrid(somePoints([], [])).nearest(0, 0, 1)).toBe(-1);
    expect(new PointGrid(somePoints([1, 1], [2, 2])).nearest(1, 2, 0.1)).toBeGreaterThanOrEqual(0);
  });
});

describe("points of a box", () => {
  it("are those that a look at all of them finds", () => {
    const box = { left: 2, right: 5, bottom: -1, top: 0.5 };
    const expected = Array.from({ length: N }, (_, i) => i).filter((i) => {
      const [x, y] = [points.x[i] ?? 0, points.y[i] ?? 0];
      return x >= box.left && x <= box.right && y >= box.bottom && y <= box.top;
    });
    expect(expected.length).toBeGreaterThan(50);
    expect(grid.within(box)).toEqual(expected);
  });
});

describe("lasso", () => {
  const star: Place[] = [
    [1, -1.5],
    [9, 1.8],
    [2, 1.9],
    [8, -1.9],
    [5, 0.2],
  ];

  it("finds the points that the even-odd rule finds among all of them", () => {
    const expected = Array.from({ length: N }, (_, i) => i).filter((i) =>
      isInside(star, points.x[i] ?? 0, points.y[i] ?? 0),
    );
    expect(expected.length).toBeGreaterThan(50);
    expect(pointsInside(points, grid, star)).toEqual(expected);
  });

  it("a square has its inside and not its outside", () => {
    const square: Place[] = [
      [0, 0],
      [2, 0],
      [2, 2],
      [0, 2],
    ];
    expect(isInside(square, 1, 1)).toBe(true);
    expect(isInside(square, 3, 1)).toBe(false);
    expect(isInside(square, -1, 1)).toBe(false);
  });

  it("a line is no lasso", () => {
    expect(
      pointsInside(points, grid, [
        [0, 0],
        [9, 1],
      ]),
    ).toEqual([]);
  });
});
