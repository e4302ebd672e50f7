/** Colours of tokens as a canvas needs them. */

export const N_SERIES_COLOURS = 6;

/** Lines that follow each other differ in their dashes, too. */
export const DASHES: readonly (readonly number[])[] = [[], [7, 4], [2, 3], [10, 3, 2, 3], [5, 2], [1, 4]];

/** What a token's colour is in the scheme that holds now, such as "rgb(0, 95, 163)". */
export function resolvedColour(token: string, within: HTMLElement): string {
  const probe = document.createElement("span");
  probe.style.color = `var(${token})`;
  within.append(probe);
  const colour = getComputedStyle(probe).color;
  probe.remove();
  return colour;
}
