/** Colours of faces: of parts, of patches, of a heat map, as sRGB bytes. */

export type Rgb = readonly [red: number, green: number, blue: number];

export interface Palette {
  readonly unlabelled: string;
  /** `#RRGGBB` by part id. */
  readonly colours: ReadonlyMap<number, string>;
}

/** The palette of parts, with the grey of the scheme that `element` is shown in. */
export function paletteOf(element: Element, parts: Iterable<{ id: number; colour: string }>): Palette {
  const colours = new Map<number, string>();
  for (const { id, colour } of parts) colours.set(id, colour);
  return { unlabelled: resolvedColour(element, "var(--unlabelled)"), colours };
}

/** What a CSS colour, also of a token, comes to below `element`, as `#rrggbb`. */
export function resolvedColour(element: Element, colour: string): string {
  const probe = document.createElement("span");
  probe.style.color = colour;
  probe.hidden = true;
  element.append(probe);
  const computed = getComputedStyle(probe).color;
  probe.remove();
  const [red = 0, green = 0, blue = 0] = (computed.match(/[\d.]+/g) ?? []).map(Number);
  return `#${[red, green, blue].map((value) => Math.round(value).toString(16).padStart(2, "0")).join("")}`;
}

/** Of `#RRGGBB`; grey for what is none, because a colour is no reason to show nothing. */
export function rgbOf(colour: string): Rgb {
  if (!/^#[0-9a-f]{6}$/i.test(colour)) return [128, 128, 128];
  const value = Number.parseInt(colour.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}

const GOLDEN_ANGLE = 137.50776;
const TINT_STRENGTH = 0.22;
const LEVEL_STEP = 0.14;
const WHITE: Rgb = [255, 255, 255];

/** A pale tint of the unlabelled grey for a patch: near ones differ, none looks like a part. */
export function patchTint(patch: number, grey: Rgb): Rgb {
  const hue = ((patch * GOLDEN_ANGLE) % 360) / 60;
  const pure: Rgb = [
    255 * clamped(Math.abs(hue - 3) - 1),
    255 * clamped(2 - Math.abs(hue - 2)),
    255 * clamped(2 - Math.abs(hue - 4)),
  ];
  const tinted = mixed(grey, pure, TINT_STRENGTH);
  return mixed(tinted, WHITE, (patch % 3) * LEVEL_STEP); // levels, for those who see no hue
}

const COLD: Rgb = [72, 88, 118];
const WARM: Rgb = [236, 120, 40];
const HOT: Rgb = [255, 232, 140];

/** From slate over orange to pale yellow: ascending lightness, so that it also reads without hue. */
export function heatColour(value: number): Rgb {
  const t = clamped(value);
  return t < 0.5 ? mixed(COLD, WARM, 2 * t) : mixed(WARM, HOT, 2 * t - 1);
}

/** The same colours from left to right, for CSS: what a legend shows. */
export const HEAT_GRADIENT = `linear-gradient(to right, ${[COLD, WARM, HOT].map((rgb) => `rgb(${rgb.join(" ")})`).join(", ")})`;

function mixed(from: Rgb, to: Rgb, share: number): Rgb {
  const between = (axis: 0 | 1 | 2) => Math.round(from[axis] + (to[axis] - from[axis]) * share);
  return [between(0), between(1), between(2)];
}

function clamped(value: number): number {
  return Math.max(0, Math.min(1, value));
}
