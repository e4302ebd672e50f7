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

/** A disc: for each pixel around its middle, how much of it is covered, from 0 to 255. */
export interface Stamp {
  readonly reach: number;
  readonly cover: Uint8Array;
}

export function stampOf(radius: number): Stamp {
  const reach = Math.ceil(radius);
  const side = 2 * reach + 1;
  const cover = new Uint8Array(side * side);
  for (let y = -reach; y <= reach; y++) {
    for (let x = -reach; x <= reach; x++) {
      const inside = radius + 0.5 - Math.hypot(x, y);
      cover[(y + reach) * side + x + reach] = Math.round(Math.min(1, Math.max(0, inside)) * 255);
    }
  }
  return { reach, cover };
}

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
  const { reach, cover } = stampOf(look.radius);
  const left = width / 2 - camera.x * camera.scale;
  const top = height / 2 + camera.y * camera.scale;
  for (let i = 0; i < n; i++) {
    const px = Math.round(left + (x[i] as number) * camera.scale);
    const py = Math.round(top - (y[i] as number) * camera.scale);
    if (px < -reach || py < -reach || px >= width + reach || py >= height + reach) continue;
    const colour = look.palette[look.kind[i] as number] as number;
    let at = 0;
    for (let row = py - reach; row <= py + reach; row++) {
      for (let column = px - reach; column <= px + reach; column++) {
        const share = cover[at++] as number;
        if (share === 0 || row < 0 || column < 0 || row >= height || column >= width) continue;
        const pixel = row * width + column;
        pixels[pixel] = share === 255 ? colour : over(colour, pixels[pixel] as number, share);
      }
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
