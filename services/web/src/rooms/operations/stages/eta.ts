/** How many shapes a stage still has before it, and when it will be through with them. */

export interface StageCount {
  stage: string;
  done: number;
  failed: number;
}

/** For each stage, in their order, shapes that reach it: what an earlier one gave up never does. */
export function shapesBefore(stages: readonly StageCount[], nShapes: number): readonly number[] {
  let n = nShapes;
  return stages.map(({ failed }) => {
    const reaching = n;
    n = Math.max(0, n - failed);
    return reaching;
  });
}

/** Seconds until nothing is left, at the pace of lately; null where nobody knows. */
export function etaInSeconds(nLeft: number, perMin: number): number | null {
  if (nLeft <= 0 || perMin <= 0) return null;
  return (nLeft / perMin) * 60;
}
