/** What labelling a shape has cost so far, counted as `partwise.labels.annotation_cost` does when it is confirmed. */
import type { StrokeJson } from "./strokes";

/** A longer pause is not counted as work. */
export const IDLE_AFTER_MS = 30_000;

export interface Effort {
  /** Between successive strokes, and from the opening to the first. */
  readonly activeMs: number;
  /** Every press, also those that were taken back: it was done. */
  readonly nClicks: number;
}

/** strokes : of one person on one shape. openedAt : when it was first shown to them, ISO 8601. */
export function effortOf(strokes: readonly Pick<StrokeJson, "at">[], openedAt: string): Effort {
  const times = strokes.map((stroke) => Date.parse(stroke.at)).sort((a, b) => a - b);
  let last = Math.min(Date.parse(openedAt), times[0] ?? Number.POSITIVE_INFINITY);
  let activeMs = 0;
  for (const time of times) {
    if (time - last <= IDLE_AFTER_MS) activeMs += time - last;
    last = time;
  }
  return { activeMs, nClicks: strokes.length };
}
