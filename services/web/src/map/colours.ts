/** Colours of points: clusters by hues that stay apart for colour-blind people, states by the page's own. */
import { type MapPoints, NO_CLUSTER } from "./mapPoints";
import { packed } from "./paintPoints";

export type Colouring = "cluster" | "state";

/** Okabe and Ito's, and darker and lighter ones of them; beyond, they begin again and the pointer tells which is which. */
// biome-ignore format: a table
export const CLUSTER_COLOURS = [
  "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00",
  "#7570b3", "#a6761d", "#66a61e", "#b2476b", "#3f8fa6", "#8c6d31",
] as const;

export function clusterColour(cluster: number): string {
  return CLUSTER_COLOURS[cluster % CLUSTER_COLOURS.length] as string;
}

/** Names of the page's colours for the states, in the order of POINT_STATES. */
export const STATE_TOKENS: readonly string[] = [
  "--border-strong",
  "--bad",
  "--accent",
  "--warning",
  "--good",
];

/** What an element's tokens are now, packed; they change with the scheme. */
export function tokenColours(element: HTMLElement, tokens: readonly string[]): number[] {
  const probe = document.createElement("span");
  element.append(probe);
  const found = tokens.map((token) => {
    probe.style.color = `var(${token})`;
    return packedOf(getComputedStyle(probe).color);
  });
  probe.remove();
  return found;
}

/** Of "rgb(1, 2, 3)" or "#010203". */
export function packedOf(colour: string): number {
  const hex = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(colour);
  const parts = hex
    ? hex.slice(1).map((part) => Number.parseInt(part, 16))
    : (colour.match(/[\d.]+/g) ?? []).map(Number);
  return packed(parts[0] ?? 0, parts[1] ?? 0, parts[2] ?? 0);
}

/** For each point, which colour of the palette it has; the last one is of points without a cluster. */
export function kindsOf(points: MapPoints, colouring: Colouring): Uint8Array {
  if (colouring === "state") return points.state;
  const n = CLUSTER_COLOURS.length;
  return Uint8Array.from(points.cluster, (cluster) => (cluster === NO_CLUSTER ? n : cluster % n));
}

export function paletteOf(element: HTMLElement, colouring: Colouring): Uint32Array {
  if (colouring === "state") return Uint32Array.from(tokenColours(element, STATE_TOKENS));
  const rest = tokenColours(element, [STATE_TOKENS[0] as string]);
  return Uint32Array.from([...CLUSTER_COLOURS.map(packedOf), ...rest]);
}
