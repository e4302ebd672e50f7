import { Box3, PerspectiveCamera, Sphere, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { frustumOf, partAround } from "./viewPart";

const WHOLE = { left: 0, bottom: 0, width: 400, height: 200 };
const camera = new PerspectiveCamera(90, 2, 0.1, 100); // sees 10 to each side and 5 up and down at a distance of 5
camera.position.set(0, 0, 5);
camera.updateMatrixWorld();
const boxAt = (x: number, y: number, z = 0, size = 0.1) =>
  new Box3().setFromCenterAndSize(new Vector3(x, y, z), new Vector3(size, size, size));

describe("the part of a view in which a box shows", () => {
  it("is where the box is, with room for lines", () => {
    const part = partAround(boxAt(5, 2.5), camera, WHOLE);
    const { left, bottom, width, height } = part ?? WHOLE;
    expect(Math.abs(left + width / 2 - 300)).toBeLessThan(2);
    expect(Math.abs(bottom + height / 2 - 150)).toBeLessThan(2);
    expect(width).toBeGreaterThan(12);
    expect(width).toBeLessThan(20);
  });

  it("ends where the view ends", () => {
    const part = partAround(boxAt(-10, 0, 0, 2), camera, WHOLE);
    expect(part?.left).toBe(0);
    expect(part?.width).toBeLessThan(60);
  });

  it("is none for an empty box, and for one beside the view", () => {
    expect(partAround(new Box3(), camera, WHOLE)).toBeNull();
    expect(partAround(boxAt(30, 0), camera, WHOLE)).toBeNull();
  });

  it("is the whole view for a box that reaches behind the camera", () => {
    expect(partAround(boxAt(0, 0, 5, 2), camera, WHOLE)).toBe(WHOLE);
  });
});

describe("what is seen in a part of a view", () => {
  const sees = (x: number, y: number, part: typeof WHOLE) =>
    frustumOf(camera, part, WHOLE).intersectsSphere(new Sphere(new Vector3(x, y, 0), 0.2));

  it("is what lies there", () => {
    const part = { left: 280, bottom: 130, width: 40, height: 40 };
    expect([sees(5, 2.5, part), sees(-5, 2.5, part), sees(5, -2.5, part), sees(0, 0, part)]).toEqual([
      true,
      false,
      false,
      false,
    ]);
  });

  it("is all that the camera sees in all of it, and the camera stays as it was", () => {
    const before = camera.projectionMatrix.clone();
    expect([sees(-9, 4, WHOLE), sees(9, -4, WHOLE), sees(12, 0, WHOLE)]).toEqual([true, true, false]);
    expect(camera.projectionMatrix).toEqual(before);
  });
});
