import { describe, expect, it } from "vitest";
import { packed, paintPoints, stampOf } from "./paintPoints";
import { somePoints } from "./testing";

const EXTENT = { width: 20, height: 10 };
const CAMERA = { x: 0, y: 0, scale: 1 };
const RED = packed(255, 0, 0);
const BLUE = packed(0, 0, 255);

function painted(x: number[], y: number[], kinds: number[]): Uint32Array {
  const pixels = new Uint32Array(EXTENT.width * EXTENT.height);
  paintPoints(pixels, EXTENT, somePoints(x, y), CAMERA, {
    kind: Uint8Array.from(kinds),
    palette: Uint32Array.from([RED, BLUE]),
    radius: 1,
  });
  return pixels;
}

const at = (pixels: Uint32Array, x: number, y: number) => pixels[y * EXTENT.width + x];

describe("paintPoints", () => {
  it("draws a point in its colour where the camera sees it, y upwards", () => {
    const pixels = painted([2], [3], [1]);
    expect(at(pixels, 12, 2)).toBe(BLUE);
    expect(at(pixels, 12, 8)).toBe(0);
  });

  it("draws later points over earlier ones", () => {
    expect(at(painted([0, 0], [0, 0], [0, 1]), 10, 5)).toBe(BLUE);
  });

  it("cuts off what is outside, without wrapping into the next row", () => {
    const pixels = painted([9.6], [0], [0]);
    expect([...pixels].filter((pixel) => pixel !== 0).length).toBeGreaterThan(0);
    expect(at(pixels, 0, 5)).toBe(0);
    expect(at(pixels, 0, 6)).toBe(0);
    expect(painted([100], [100], [0]).every((pixel) => pixel === 0)).toBe(true);
  });

  it("has soft edges", () => {
    const corner = at(painted([0], [0], [0]), 11, 6) ?? 0;
    expect(corner >>> 24).toBeGreaterThan(0);
    expect(corner >>> 24).toBeLessThan(255);
  });
});

describe("stampOf", () => {
  it("covers the middle in full and is the same on every side", () => {
    const { dx, dy, cover } = stampOf(2.5, true);
    const middle = dx.findIndex((x, k) => x === 0 && dy[k] === 0);
    expect(cover[middle]).toBe(255);
    expect([...cover]).toEqual([...cover].reverse());
  });

  it("has hard edges where there are many points", () => {
    expect([...stampOf(2.5, false).cover].every((share) => share === 255)).toBe(true);
    expect([...stampOf(2.5, true).cover].some((share) => share < 255)).toBe(true);
  });
});
