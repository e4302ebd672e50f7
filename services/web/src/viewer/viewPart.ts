/** Parts of a view: what of it a change concerns, and what of the shape is seen in them. */
import { type Box3, Frustum, Matrix4, type PerspectiveCamera, Vector4 } from "three";

/** A rectangle in pixels of CSS, from the view's lower left. */
export interface ViewPart {
  readonly left: number;
  readonly bottom: number;
  readonly width: number;
  readonly height: number;
}

/** Lines are drawn so far beside what they are about, and pixels are whole. */
const MARGIN = 6;

/** The part in which a box shows, within the whole view; null where nothing of it does. */
export function partAround(box: Box3, camera: PerspectiveCamera, whole: ViewPart): ViewPart | null {
  if (box.isEmpty()) return null;
  const toView = projection(camera);
  let [left, right, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let corner = 0; corner < 8; corner += 1) {
    const point = new Vector4(
      corner & 1 ? box.max.x : box.min.x,
      corner & 2 ? box.max.y : box.min.y,
      corner & 4 ? box.max.z : box.min.z,
      1,
    ).applyMatrix4(toView);
    if (point.w <= camera.near) return whole; // it reaches behind the camera
    const x = ((point.x / point.w + 1) / 2) * whole.width;
    const y = ((point.y / point.w + 1) / 2) * whole.height;
    left = Math.min(left, x);
    right = Math.max(right, x);
    bottom = Math.min(bottom, y);
    top = Math.max(top, y);
  }
  left = Math.max(0, Math.floor(left) - MARGIN);
  bottom = Math.max(0, Math.floor(bottom) - MARGIN);
  const width = Math.min(whole.width, Math.ceil(right) + MARGIN) - left;
  const height = Math.min(whole.height, Math.ceil(top) + MARGIN) - bottom;
  return width > 0 && height > 0 ? { left, bottom, width, height } : null;
}

/** What the camera sees in a part of its view. */
export function frustumOf(camera: PerspectiveCamera, part: ViewPart, whole: ViewPart): Frustum {
  const fromTop = whole.height - part.bottom - part.height;
  camera.setViewOffset(whole.width, whole.height, part.left, fromTop, part.width, part.height);
  const seen = new Frustum().setFromProjectionMatrix(projection(camera));
  camera.clearViewOffset();
  return seen;
}

function projection(camera: PerspectiveCamera): Matrix4 {
  return new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
}
