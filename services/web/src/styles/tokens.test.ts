/** Text on every surface that it may stand on has a contrast of AA, in both schemes. */
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";

const AA_TEXT = 4.5;
const AA_GRAPHICS = 3;
const PAIR = /--([\w-]+):\s*light-dark\((#[0-9a-f]{6}),\s*(#[0-9a-f]{6})\)/g;

const source = readFileSync(new URL("./tokens.css", import.meta.url), "utf8");
const tokens = new Map(
  [...source.matchAll(PAIR)].map(([, name, light, dark]) => [name ?? "", { light, dark }]),
);

/** WCAG 2.2: relative luminance of an sRGB colour. */
function luminance(hex: string): number {
  const [red = 0, green = 0, blue = 0] = [1, 3, 5].map((at) => {
    const value = Number.parseInt(hex.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

function contrast(one: string, other: string): number {
  const [darker = 0, lighter = 0] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (lighter + 0.05) / (darker + 0.05);
}

function contrastOf(scheme: "light" | "dark", text: string, surface: string): number {
  const colours = [tokens.get(text)?.[scheme], tokens.get(surface)?.[scheme]];
  if (!colours[0] || !colours[1])
    throw new Error(`tokens.css has no --${text} or no --${surface} of two colours`);
  return contrast(colours[0], colours[1]);
}

const PLAIN = ["surface", "surface-raised", "surface-sunken", "surface-hover"];
const TEXT_ON: Readonly<Record<string, readonly string[]>> = {
  text: [...PLAIN, "accent-surface", "good-surface", "warning-surface", "bad-surface"],
  "text-muted": PLAIN,
  accent: ["surface", "surface-raised", "surface-sunken"],
  "accent-strong": [...PLAIN, "accent-surface"],
  "on-accent": ["accent", "accent-strong"],
  good: ["surface", "surface-raised", "good-surface"],
  warning: ["surface", "surface-raised", "warning-surface"],
  bad: ["surface", "surface-raised", "surface-sunken", "bad-surface"],
};
const MARKS_ON: Readonly<Record<string, readonly string[]>> = {
  "border-strong": ["surface", "surface-raised", "surface-sunken"],
  ...Object.fromEntries([1, 2, 3, 4, 5, 6].map((n) => [`series-${n}`, ["surface-raised"]])),
};

function cases(pairs: Readonly<Record<string, readonly string[]>>) {
  return (["light", "dark"] as const).flatMap((scheme) =>
    Object.entries(pairs).flatMap(([mark, surfaces]) =>
      surfaces.map((surface) => ({ scheme, mark, surface })),
    ),
  );
}

describe("colour tokens", () => {
  it("tells black and white apart as WCAG does", () => {
    expect(contrast("#000000", "#ffffff")).toBeCloseTo(21);
  });

  it.each(cases(TEXT_ON))("$mark can be read on $surface when $scheme", ({ scheme, mark, surface }) => {
    expect(contrastOf(scheme, mark, surface)).toBeGreaterThanOrEqual(AA_TEXT);
  });

  it.each(cases(MARKS_ON))("$mark can be seen on $surface when $scheme", ({ scheme, mark, surface }) => {
    expect(contrastOf(scheme, mark, surface)).toBeGreaterThanOrEqual(AA_GRAPHICS);
  });
});
