import { Matrix4, Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import {
  FIELD_OF_VIEW,
  framed,
  moved,
  type NamedView,
  namedOrientation,
  type Pose,
  turned,
  type UpAxis,
  uprightRotation,
  zoomed,
} from "./pose";

const FRONT = new Vector3(0, 0, 1);
const start = (name: NamedView = "front"): Pose => ({
  orientation: namedOrientation(name),
  offset: new Vector3(),
  distance: 2,
});
const towards = ({ orientation }: Pose) => FRONT.clone().applyQuaternion(orientation);
const aside = ({ orientation }: Pose) => new Vector3(1, 0, 0).applyQuaternion(orientation);

/** Where the camera sees a point: right and up in heights of the view from its middle. */
function seen({ orientation, offset, distance }: Pose, point: Vector3): [number, number] {
  const local = point.clone().sub(offset).applyQuaternion(orientation.clone().invert());
  const height = 2 * Math.tan(FIELD_OF_VIEW / 2) * (distance - local.z);
  return [local.x / height, local.y / height];
}

describe("a turntable", () => {
  it("turns what is seen with the pointer", () => {
    const nose = new Vector3(0, 0, 0.5);
    const pose = turned(start(), 0.3, 0.2);
    const [right, up] = seen(pose, nose);
    expect(right).toBeGreaterThan(0);
    expect(up).toBeLessThan(0);
  });

  it("keeps the horizon level, and stops short of the top", () => {
    let pose = start("threeQuarter");
    for (let step = 0; step < 50; step += 1) pose = turned(pose, 0.4, 0.3);
    expect(aside(pose).y).toBeCloseTo(0, 12);
    expect(towards(pose).y).toBeGreaterThan(0.99);
    expect(towards(turned(pose, 0, -0.5)).y).toBeLessThan(0.95);
  });

  it("levels a camera that was rolled", () => {
    const rolled = { ...start(), orientation: new Quaternion().setFromAxisAngle(FRONT, 0.7) };
    expect(aside(turned(rolled, 0.1, 0)).y).toBeCloseTo(0, 12);
  });
});

describe("moving and zooming", () => {
  it("keep what is under the pointer there", () => {
    const point = new Vector3(0.2, 0.1, 0);
    const before = seen(start(), point);
    const pose = zoomed(start(), 0.5, ...before);
    expect(pose.distance).toBe(1);
    expect(seen(pose, point)[0]).toBeCloseTo(before[0], 12);
    expect(seen(pose, point)[1]).toBeCloseTo(before[1], 12);
    expect(seen(moved(start(), 0.1, 0.2), point)[0]).toBeCloseTo(before[0] + 0.1, 12);
  });

  it("end before the surface and before the shape is a dot", () => {
    expect(zoomed(start(), 1e-9).distance).toBeGreaterThan(0.001);
    expect(zoomed(start(), 1e9).distance).toBeLessThan(100);
  });
});

describe("framing", () => {
  const cube = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-1, 1].map((z) => new Vector3(x, y, z))));

  it.each([0.5, 1, 2])("shows all points closely in a view of aspect %s", (aspect) => {
    const points = Float32Array.from(cube.flatMap((corner) => [...corner]));
    const pose = framed(namedOrientation("threeQuarter"), points, new Matrix4(), aspect);
    const places = cube.map((point) => seen(pose, point));
    const right = Math.max(...places.map(([x]) => Math.abs(x))) / aspect;
    const up = Math.max(...places.map(([, y]) => Math.abs(y)));
    expect(Math.max(right, up)).toBeLessThan(0.45);
    expect(Math.max(right, up)).toBeGreaterThan(0.43);
  });
});

describe("named views", () => {
  it.each([
    ["front", [0, 0, 1]],
    ["back", [0, 0, -1]],
    ["left", [-1, 0, 0]],
    ["right", [1, 0, 0]],
    ["top", [0, 1, 0]],
    ["bottom", [0, -1, 0]],
  ] as const)("%s", (name, [x, y, z]) => {
    expect(towards(start(name)).distanceTo(new Vector3(x, y, z))).toBeLessThan(0.01);
  });
});

describe("up", () => {
  it.each(["x", "y", "z", "-x", "-y", "-z"] as UpAxis[])("%s is up, and the axis after it in front", (up) => {
    const turn = uprightRotation(up);
    const axis = "xyz".indexOf(up.at(-1) as string);
    const upward = new Vector3(0, 1, 0).applyQuaternion(turn);
    const front = FRONT.clone().applyQuaternion(turn);
    expect(upward.getComponent(axis)).toBeCloseTo(up.startsWith("-") ? -1 : 1, 12);
    expect(front.getComponent((axis + 1) % 3)).toBeCloseTo(1, 12);
  });
});
