/** How the stage is divided, kept in this browser. */
export type ViewCount = 1 | 2 | 3 | 4;
export type ViewContent = "cameras" | "shapes";

export interface Views {
  readonly count: ViewCount;
  /** Several cameras on the shape in hand, or a shape in each. */
  readonly content: ViewContent;
  readonly isLinked: boolean;
}

export const VIEW_COUNTS: readonly ViewCount[] = [1, 2, 3, 4];
/** Where each camera looks from at first. */
export const FIRST_LOOKS = ["threeQuarter", "back", "left", "top"] as const;

export function nextCount(count: ViewCount): ViewCount {
  return VIEW_COUNTS[count % VIEW_COUNTS.length] ?? 1;
}
