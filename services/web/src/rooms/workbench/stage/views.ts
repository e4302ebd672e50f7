/** How the stage is divided, and what each of its views shows. */
import type { Shown } from "./shown";

export type ViewCount = 1 | 2 | 3 | 4;
export type ViewContent = "cameras" | "shapes";

export interface Views {
  readonly count: ViewCount;
  /** Several cameras on the shape in hand, or a shape in each. */
  readonly content: ViewContent;
  readonly isLinked: boolean;
  /** Of the view at each place; the draft where it is left out. */
  readonly shown: readonly (Shown | undefined)[];
  /** Whether the edges of all faces are drawn. */
  readonly hasEdges: boolean;
}

export const ONE_VIEW: Views = {
  count: 1,
  content: "cameras",
  isLinked: false,
  shown: [],
  hasEdges: false,
};

export const VIEW_COUNTS: readonly ViewCount[] = [1, 2, 3, 4];
/** Where each camera looks from at first. */
export const FIRST_LOOKS = ["threeQuarter", "back", "left", "top"] as const;

export function nextCount(count: ViewCount): ViewCount {
  return VIEW_COUNTS[count % VIEW_COUNTS.length] ?? 1;
}

export function shownAt(views: Views, place: number): Shown {
  return views.shown[place] ?? "draft";
}

/** What is shown, with something else at one place. */
export function withShown(views: Views, place: number, shown: Shown): Views["shown"] {
  return VIEW_COUNTS.map((_, at) => (at === place ? shown : views.shown[at]));
}

/** What each of `count` views has where each has a shape of its own: the first, and always the one in hand. */
export function inViews<Shape>(
  shapes: readonly Shape[],
  current: Shape | null,
  count: ViewCount,
): readonly (Shape | null)[] {
  const shown: (Shape | null)[] = Array.from({ length: count }, (_, at) => shapes[at] ?? null);
  if (current !== null && !shown.includes(current)) shown[count - 1] = current;
  return shown;
}
