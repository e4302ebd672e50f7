/** How well colours of parts can be told apart, by everybody, on the page's backgrounds. */

export type Rgb = readonly [red: number, green: number, blue: number];

/** Behind shapes in either scheme, and of faces without a label, as in the page's tokens. */
const STAGES: readonly string[] = ["#e9ebee", "#202328"];
const UNLABELLED: readonly string[] = ["#b4b9c1", "#7d838d"];

/** Of graphics, by WCAG 2.2 (1.4.11) it would be 3; shapes are shaded and large, so that half of the way is enough. */
const LEAST_CONTRAST = 1.35;
/** In CIE 1976 units (ΔE*ab); below, colours are easily taken for each other. */
const LEAST_DIFFERENCE = 16;

/** Okabe and Ito's, then others that stay apart from them for all common kinds of colour blindness. */
// biome-ignore format: a palette
export const SUGGESTED_COLOURS: readonly string[] = [
  "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#332288",
  "#882255", "#44AA99", "#999933", "#AA4499", "#DDCC77", "#117733", "#88CCEE", "#661100",
];

export function rgbOf(colour: string): Rgb {
  const value = Number.parseInt(colour.slice(1), 16);
  return [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

/** From 1 (the same lightness) to 21 (black on white), by WCAG 2. */
export function contrast(one: string, other: string): number {
  const [a, b] = [luminance(rgbOf(one)), luminance(rgbOf(other))].sort((x, y) => y - x) as [number, number];
  return (a + 0.05) / (b + 0.05);
}

export const SIGHTS = ["usual", "protanopia", "deuteranopia", "tritanopia"] as const;
export type Sight = (typeof SIGHTS)[number];

/** Distance of two colours as seen by somebody, ΔE*ab. */
export function difference(one: string, other: string, sight: Sight = "usual"): number {
  const a = labOf(seenBy(rgbOf(one), sight));
  const b = labOf(seenBy(rgbOf(other), sight));
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** What is wrong with a colour beside others; null if nothing is. `others`: names and colours of the other parts. */
export function colourWarning(colour: string, others: ReadonlyMap<string, string>): string | null {
  for (const [name, other] of others) {
    if (other.toLowerCase() === colour.toLowerCase()) return `The same colour as ${name}.`;
    if (difference(colour, other) < LEAST_DIFFERENCE) return `Hard to tell from ${name}.`;
  }
  for (const [name, other] of others) {
    const blind = SIGHTS.slice(1).find((sight) => difference(colour, other, sight) < LEAST_DIFFERENCE / 2);
    if (blind) return `Hard to tell from ${name} with ${blind}.`;
  }
  if (UNLABELLED.some((each) => difference(colour, each) < LEAST_DIFFERENCE)) {
    return "Looks like faces without a label.";
  }
  if (STAGES.some((each) => contrast(colour, each) < LEAST_CONTRAST)) {
    return "Hard to see on the background in one of the schemes.";
  }
  return null;
}

/** The first colour suggested that is well apart from all of these; the one that is farthest if none is. */
export function nextColour(taken: readonly string[]): string {
  const names = new Map(taken.map((colour, i) => [String(i), colour]));
  const free = SUGGESTED_COLOURS.find((colour) => colourWarning(colour, names) === null);
  if (free !== undefined) return free;
  const apart = (colour: string) => Math.min(...taken.map((other) => difference(colour, other)));
  return [...SUGGESTED_COLOURS].sort((a, b) => apart(b) - apart(a))[0] as string;
}

function linear(value: number): number {
  const share = value / 255;
  return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
}

function luminance(colour: Rgb): number {
  const [r, g, b] = colour.map(linear) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Full dichromacy, on linear light. Source: Machado, Oliveira & Fernandes 2009, severity 1. */
const SEEN: Readonly<Record<Exclude<Sight, "usual">, readonly (readonly [number, number, number])[]>> = {
  protanopia: [
    [0.152286, 1.052583, -0.204868],
    [0.114503, 0.786281, 0.099216],
    [-0.003882, -0.048116, 1.051998],
  ],
  deuteranopia: [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ],
  tritanopia: [
    [1.255528, -0.076749, -0.178779],
    [-0.078411, 0.930809, 0.147602],
    [0.004733, 0.691367, 0.3039],
  ],
};

/** Linear light in [0, 1] that a colour is to somebody. */
function seenBy(colour: Rgb, sight: Sight): readonly [number, number, number] {
  const light = colour.map(linear) as [number, number, number];
  if (sight === "usual") return light;
  const seen = SEEN[sight].map((row) => row[0] * light[0] + row[1] * light[1] + row[2] * light[2]);
  return seen.map((value) => Math.min(1, Math.max(0, value))) as [number, number, number];
}

/** CIE L*a*b* of linear sRGB under D65. */
function labOf([r, g, b]: readonly [number, number, number]): readonly [number, number, number] {
  const f = (t: number) => (t > 216 / 24389 ? Math.cbrt(t) : ((24389 / 27) * t + 16) / 116);
  const x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
  const y = f(0.2126729 * r + 0.7151522 * g + 0.072175 * b);
  const z = f((0.0193339 * r + 0.119192 * g + 0.9503041 * b) / 1.08883);
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}
