/**
 * Where a camera is, in terms that fit every shape: turned from the front with up up, and in diagonals from the middle.
 * So the pose of one shape can be given to another, and all here is arithmetic.
 */
import { Matrix4, Quaternion, Vector3 } from "three";

export type UpAxis = "x" | "y" | "z" | "-x" | "-y" | "-z";
export type NamedView = "front" | "back" | "left" | "right" | "top" | "bottom" | "threeQuarter";

export interface Pose {
  /** From looking at the front (towards −z, y up) to how the camera looks. */
  readonly orientation: Quaternion;
  /** From the shape's middle to what the camera turns about, in diagonals; right, up, front. */
  readonly offset: Vector3;
  /** From there to the camera, in diagonals. */
  readonly distance: number;
}

/** Radians from top to bottom: long enough a lens that proportions stay true. */
export const FIELD_OF_VIEW = 0.42;
const NEAREST = 0.02;
const FARTHEST = 30;
const STEEPEST = 0.499 * Math.PI;
const RIGHT = new Vector3(1, 0, 0);
const UP = new Vector3(0, 1, 0);
const FRONT = new Vector3(0, 0, 1);

/** Towards the camera: right, up, front. Three-quarter is that of the service's pictures. */
const DIRECTIONS: Readonly<Record<NamedView, readonly [number, number, number]>> = {
  front: [0, 0, 1],
  back: [0, 0, -1],
  left: [-1, 0, 0],
  right: [1, 0, 0],
  top: [0, 1, 0],
  bottom: [0, -1, 0],
  threeQuarter: [0.55, 0.42, 1],
};

export function namedOrientation(name: NamedView): Quaternion {
  const [x, y, z] = DIRECTIONS[name];
  const yaw = x === 0 && z === 0 ? 0 : Math.atan2(x, z);
  return levelOrientation(yaw, Math.atan2(y, Math.hypot(x, z)));
}

/** Turned to the right by `yaw`, then up by `pitch`, radians; short of straight up and down. */
export function levelOrientation(yaw: number, pitch: number): Quaternion {
  const steep = Math.max(-STEEPEST, Math.min(STEEPEST, pitch));
  const turn = new Quaternion().setFromAxisAngle(UP, yaw);
  return turn.multiply(new Quaternion().setFromAxisAngle(RIGHT, -steep));
}

/** The pose turned by a gesture to the right and down, radians, as on a turntable: up stays up. */
export function turned(pose: Pose, right: number, down: number): Pose {
  const towards = FRONT.clone().applyQuaternion(pose.orientation);
  const aside = RIGHT.clone().applyQuaternion(pose.orientation); // level, also where towards is not
  const yaw = Math.atan2(-aside.z, aside.x);
  const pitch = Math.asin(Math.max(-1, Math.min(1, towards.y)));
  return { ...pose, orientation: levelOrientation(yaw - right, pitch + down) };
}

/** The pose moved by a gesture to the right and up, in heights of the view: what is under the pointer stays there. */
export function moved(pose: Pose, right: number, up: number): Pose {
  const height = 2 * Math.tan(FIELD_OF_VIEW / 2) * pose.distance;
  const shift = new Vector3(-right * height, -up * height, 0).applyQuaternion(pose.orientation);
  return { ...pose, offset: pose.offset.clone().add(shift) };
}

/**
 * The pose nearer (factor < 1) or farther. What is at (right, up), in heights of the view from its middle, stays there.
 */
export function zoomed(pose: Pose, factor: number, right = 0, up = 0): Pose {
  const distance = Math.max(NEAREST, Math.min(FARTHEST, pose.distance * factor));
  const share = 1 - distance / pose.distance;
  return { ...moved(pose, -right * share, -up * share), distance };
}

/** Rotation from (right, up, front) to a mesh's axes; front is the axis after up in x → y → z → x. */
export function uprightRotation(up: UpAxis): Quaternion {
  const axis = "xyz".indexOf(up.at(-1) as string);
  const upward = new Vector3().setComponent(axis, up.startsWith("-") ? -1 : 1);
  const front = new Vector3().setComponent((axis + 1) % 3, 1);
  const turn = new Quaternion().setFromUnitVectors(UP, upward);
  const turnedFront = FRONT.clone().applyQuaternion(turn);
  return new Quaternion().setFromUnitVectors(turnedFront, front).multiply(turn);
}

/**
 * The pose that frames points closely from where the camera looks now. points : (3n), in any coordinates. place : from
 * these to right, up, front, in diagonals from the shape's middle. aspect : width over height of the view. margin : free
 * share on each side.
 */
export function framed(
  orientation: Quaternion,
  points: Float32Array,
  place: Matrix4,
  aspect: number,
  margin = 0.06,
): Pose {
  const back = new Matrix4().makeRotationFromQuaternion(orientation.clone().invert()).multiply(place);
  const [xx, yx, zx, , xy, yy, zy, , xz, yz, zz, , x0, y0, z0] = back.elements;
  const slopeUp = Math.tan(FIELD_OF_VIEW / 2) * (1 - 2 * margin);
  const slopeAside = slopeUp * aspect;
  let [right, left, up, down] = [-Infinity, -Infinity, -Infinity, -Infinity];
  for (let at = 0; at < points.length; at += 3) {
    const px = points[at] as number;
    const py = points[at + 1] as number;
    const pz = points[at + 2] as number;
    const x = (xx * px + xy * py + xz * pz + x0) / slopeAside;
    const y = (yx * px + yy * py + yz * pz + y0) / slopeUp;
    const z = zx * px + zy * py + zz * pz + z0;
    if (x + z > right) right = x + z;
    if (z - x > left) left = z - x;
    if (y + z > up) up = y + z;
    if (z - y > down) down = z - y;
  }
  // The camera at (x, y, distance) sees all when right ≤ distance + x / slope, left ≤ distance − x / slope, and so on.
  const distance = Math.max((right + left) / 2, (up + down) / 2, NEAREST);
  const aside = ((right - left) / 2) * slopeAside;
  const above = ((up - down) / 2) * slopeUp;
  return { orientation, offset: new Vector3(aside, above, 0).applyQuaternion(orientation), distance };
}
