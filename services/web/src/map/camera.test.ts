import { describe, expect, it } from "vitest";
import { boxOf, type Camera, cameraOver, panned, toMap, toScreen, zoomedAt } from "./camera";
import { somePoints } from "./testing";

const EXTENT = { width: 400, height: 300 };
const CAMERA: Camera = { x: 2, y: -1, scale: 10 };

describe("camera", () => {
  it("leads to pixels and back", () => {
    const [px, py] = toScreen(CAMERA, EXTENT, 3, 4);
    expect(toMap(CAMERA, EXTENT, px, py)).toEqual([3, 4]);
  });

  it("has y upwards on the map", () => {
    expect(toScreen(CAMERA, EXTENT, 2, 0)[1]).toBeLessThan(toScreen(CAMERA, EXTENT, 2, -1)[1]);
  });

  it("fits all points with a margin", () => {
    const camera = cameraOver(boxOf(somePoints([0, 10, 5], [0, 2, -8])), EXTENT);
    for (const [x, y] of [
      [0, 0],
      [10, 2],
      [5, -8],
    ] as const) {
      const [px, py] = toScreen(camera, EXTENT, x, y);
      expect(px).toBeGreaterThan(20);
      expect(px).toBeLessThan(380);
      expect(py).toBeGreaterThan(20);
      expect(py).toBeLessThan(280);
    }
  });

  it("fits a single point, and none", () => {
    expect(cameraOver(boxOf(somePoints([3], [4])), EXTENT)).toMatchObject({ x: 3, y: 4 });
    expect(boxOf(somePoints([], []))).toEqual({ left: 0, right: 0, bottom: 0, top: 0 });
  });

  it("panning moves what is under the pointer with it", () => {
    const before = toScreen(CAMERA, EXTENT, 1, 1);
    const after = toScreen(panned(CAMERA, 30, -20), EXTENT, 1, 1);
    expect([after[0] - before[0], after[1] - before[1]]).toEqual([30, -20]);
  });

  it("zooming keeps what is under the pointer", () => {
    const zoomed = zoomedAt(CAMERA, EXTENT, [50, 60], 2, CAMERA);
    expect(zoomed.scale).toBe(20);
    const [x, y] = toMap(CAMERA, EXTENT, 50, 60);
    const [px, py] = toScreen(zoomed, EXTENT, x, y);
    expect(px).toBeCloseTo(50);
    expect(py).toBeCloseTo(60);
  });

  it("zooming ends", () => {
    expect(zoomedAt(CAMERA, EXTENT, [0, 0], 1e9, CAMERA).scale).toBe(5_000);
    expect(zoomedAt(CAMERA, EXTENT, [0, 0], 1e-9, CAMERA).scale).toBe(5);
  });
});
