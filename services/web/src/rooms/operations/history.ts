/** How figures went while the page was open: samples of what was polled, oldest first. */
import type { Ops } from "./queries";

export interface Sample {
  /** Seconds since 1970. */
  atS: number;
  perMin: Readonly<Record<string, number>>;
  free: number;
  held: number;
}

const MAX_SAMPLES = 1_080; // three hours of one each ten seconds
const MIN_GAP_S = 5; // events make polls come sooner, which says nothing more about a pace

export function withSample(history: readonly Sample[], ops: Ops, atS: number): readonly Sample[] {
  const last = history.at(-1);
  if (last && atS - last.atS < MIN_GAP_S) return history;
  const perMin = Object.fromEntries(ops.stages.map(({ stage, per_min }) => [stage, per_min]));
  return [...history, { atS, perMin, free: ops.queue.free, held: ops.queue.held }].slice(-MAX_SAMPLES);
}
