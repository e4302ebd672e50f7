/** From places on the map to pixels and back: one scale, no rotation, y upwards on the map and downwards on screen. */
import type { MapPoints } from "./mapPoints";

/** x, y : the place in the middle of the canvas. scale : pixels per unit. */
export interface Camera {
  readonly x: number;
  readonly y: number;
  readonly scale: number;
}

export interface Extent {
  readonly width: number;
  readonly height: number;
}

export interface Box {
  readonly left: number;
  readonly right: number;
  readonly bottom: number;
  readonly top: number;
}

const MARGIN_PX = 24;
/** Against one that shows everything. */
const MOST_ZOOM = 500;
const LEAST_ZOOM = 0.5;

export function boxOf({ n, x, y }: MapPoints): Box {
  if (n === 0) return { left: 0, right: 0, bottom: 0, top: 0 };
  const box = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
  for (let i = 0; i < n; i++) {
    const px = x[i] as number;
    const py = y[i] as number;
    box.left = Math.min(box.left, px);
    box.right = Math.max(box.right, px);
    box.bottom = Math.min(box.bottom, py);
    box.top = Math.max(box.top, py);
  }
  return box;
}

/** Shows all of the box, with a margin. */
export function cameraOver(box: Box, { width, height }: Extent): Camera {
  const across = Math.max(box.right - box.left, 1e-9);
  const up = Math.max(box.top - box.bottom, 1e-9);
  const scale = Math.min(
    Math.max(width - 2 * MARGIN_PX, 1) / across,
    Math.max(height - 2 * MARGIN_PX, 1) / up,
  );
  return { x: (box.left + box.right) / 2, y: (box.bottom + box.top) / 2, scale };
}

export function toScreen(camera: Camera, { width, height }: Extent, x: number, y: number): [number, number] {
  return [width / 2 + (x - camera.x) * camera.scale, height / 2 - (y - camera.y) * camera.scale];
}

export function toMap(camera: Camera, { width, height }: Extent, px: number, py: number): [number, number] {
  return [camera.x + (px - width / 2) / camera.scale, camera.y - (py - height / 2) / camera.scale];
}

export function panned(camera: Camera, dx: number, dy: number): Camera {
  return { ...camera, x: camera.x - dx / camera.scale, y: camera.y + dy / camera.scale };
}

/** Zoomed by a factor, the place under a pixel staying there. `home`: the camera that shows everything. */
export function zoomedAt(
  camera: Camera,
  extent: Extent,
  at: readonly [number, number],
  factor: number,
  home: Camera,
): Camera {
  const scale = Math.min(home.scale * MOST_ZOOM, Math.max(home.scale * LEAST_ZOOM, camera.scale * factor));
  const [x, y] = toMap(camera, extent, at[0], at[1]);
  return {
    x: x - (at[0] - extent.width / 2) / scale,
    y: y + (at[1] - extent.height / 2) / scale,
    scale,
  };
}
