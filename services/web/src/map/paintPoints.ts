/** Draws points into an image, pixel by pixel: hundreds of thousands within a frame. */
import type { Camera, Extent } from "./camera";
import type { MapPoints } from "./mapPoints";

/** Bytes in the order in which an ImageData has them, as one number on little-endian machines. */
export function packed(red: number, green: number, blue: number): number {
  return (0xff000000 | (blue << 16) | (green << 8) | red) >>> 0;
}

export interface PointLook {
  /** Of each point, an index into `palette`. */
  readonly kind: Uint8Array;
  /** Packed colours. */
  readonly palette: Uint32Array;
  /** In pixels of the image. */
  readonly radius: number;
}

/** A disc: pixels around its middle, and how much of each is covered, from 1 to 255. */
export interface Stamp {
  readonly reach: number;
  readonly dx: Int8Array;
  readonly dy: Int8Array;
  readonly cover: Uint8Array;
}

/** `isSoft`: with edges that are covered in part, which takes three times as long to draw. */
export function stampOf(radius: number, isSoft: boolean): Stamp {
  const reach = Math.ceil(radius);
  const found: [number, number, number][] = [];
  for (let y = -reach; y <= reach; y++) {
    for (let x = -reach; x <= reach; x++) {
      const share = Math.min(1, Math.max(0, radius + 0.5 - Math.hypot(x, y)));
      const cover = isSoft ? Math.round(share * 255) : share >= 0.5 ? 255 : 0;
      if (cover > 0) found.push([x, y, cover]);
    }
  }
  return {
    reach,
    dx: Int8Array.from(found, ([x]) => x),
    dy: Int8Array.from(found, ([, y]) => y),
    cover: Uint8Array.from(found, ([, , cover]) => cover),
  };
}

/** Where there are more, edges are hard: nobody sees the difference, and a frame is a frame. */
const MOST_SOFT = 20_000;

/** Draws those points that are in the picture. `pixels`: width × height packed colours; zero where nothing is. */
export function paintPoints(
  pixels: Uint32Array,
  extent: Extent,
  points: MapPoints,
  camera: Camera,
  look: PointLook,
): void {
  const { width, height } = extent;
  const { x, y, n } = points;
  const stamp = stampOf(look.radius, n <= MOST_SOFT);
  const { reach, dx, dy, cover } = stamp;
  const steps = Int32Array.from(dx, (across, k) => (dy[k] as number) * width + across);
  const left = width / 2 - camera.x * camera.scale;
  const top = height / 2 + camera.y * camera.scale;
  for (let i = 0; i < n; i++) {
    const px = Math.round(left + (x[i] as number) * camera.scale);
    const py = Math.round(top - (y[i] as number) * camera.scale);
    if (px < -reach || py < -reach || px >= width + reach || py >= height + reach) continue;
    const colour = look.palette[look.kind[i] as number] as number;
    const isWhole = px >= reach && py >= reach && px < width - reach && py < height - reach;
    const middle = py * width + px;
    for (let k = 0; k < steps.length; k++) {
      if (!isWhole) {
        const column = px + (dx[k] as number);
        const row = py + (dy[k] as number);
        if (column < 0 || row < 0 || column >= width || row >= height) continue;
      }
      const pixel = middle + (steps[k] as number);
      const share = cover[k] as number;
      pixels[pixel] = share === 255 ? colour : over(colour, pixels[pixel] as number, share);
    }
  }
}

/** A colour over what is there already, by its share of the pixel; over nothing, it is that transparent. */
function over(colour: number, under: number, share: number): number {
  if (under === 0) return ((colour & 0xffffff) | (share << 24)) >>> 0;
  const rest = 255 - share;
  const mixed = (shift: number) =>
    ((((colour >>> shift) & 255) * share + ((under >>> shift) & 255) * rest) / 255) & 255;
  const opacity = Math.max(share, under >>> 24);
  return ((opacity << 24) | (mixed(16) << 16) | (mixed(8) << 8) | mixed(0)) >>> 0;
}
