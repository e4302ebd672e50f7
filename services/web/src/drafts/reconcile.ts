/** What to do when the log on record and the log here may not be the same. */
import type { StrokeJson } from "../labels/strokes";

/** Both sides from the first stroke in which they differ: `common` strokes come before. */
export interface Divergence {
  readonly common: number;
  readonly mine: readonly StrokeJson[];
  readonly theirs: readonly StrokeJson[];
}

export type Comparison =
  /** Nothing here that is not on record, or would not follow on it: `log` is what there is now. */
  | {
      readonly kind: "agrees";
      readonly nRecorded: number;
      readonly isBehind: boolean;
      readonly log: StrokeJson[];
    }
  | { readonly kind: "diverged"; readonly divergence: Divergence };

/** Compares whole logs, stroke by stroke, by their ids. */
export function compare(here: readonly StrokeJson[], recorded: readonly StrokeJson[]): Comparison {
  const shorter = Math.min(here.length, recorded.length);
  let common = 0;
  while (common < shorter && here[common]?.id === recorded[common]?.id) common++;
  if (common < shorter) {
    const divergence = { common, mine: here.slice(common), theirs: recorded.slice(common) };
    return { kind: "diverged", divergence };
  }
  const isBehind = recorded.length > here.length;
  return { kind: "agrees", nRecorded: recorded.length, isBehind, log: isBehind ? [...recorded] : [...here] };
}

/**
 * Strokes kept here, put behind those on record: one for each place, in order. Two windows may have kept two for one
 * place, or a place may be missing; what does not fit is in `strays`, so that it is not lost either. Where others wrote
 * at these places meanwhile, the log leaves the recorded one there, for `compare` to notice.
 */
export function chained(
  recorded: readonly StrokeJson[],
  kept: readonly StrokeJson[],
): { readonly log: StrokeJson[]; readonly strays: StrokeJson[] } {
  const known = new Set(recorded.map((stroke) => stroke.id));
  const unsent = kept.filter((stroke) => !known.has(stroke.id)).sort((a, b) => a.sequence - b.sequence);
  const from = unsent[0]?.sequence ?? recorded.length;
  const log = recorded.slice(0, from);
  const strays: StrokeJson[] = [];
  for (const stroke of unsent) {
    if (stroke.sequence === log.length) log.push(stroke);
    else strays.push(stroke);
  }
  return { log, strays };
}
