/** Sets of faces as runs of consecutive indices, which is how patches and regions mostly come. */

/** Runs that ascend and do not overlap, each with one label: first face, count, label. */
export interface LabelRuns {
  readonly first: Uint32Array;
  readonly count: Uint32Array;
  readonly label: Uint16Array;
}

/** [first, count] of each run of consecutive faces, from faces in any order, repeats allowed. */
export function runsOf(faces: Iterable<number>): [first: number, count: number][] {
  const runs: [number, number][] = [];
  for (const face of Uint32Array.from(faces).sort()) {
    const last = runs.at(-1);
    if (last === undefined || face > last[0] + last[1]) runs.push([face, 1]);
    else if (face === last[0] + last[1]) last[1] += 1;
  }
  return runs;
}

/** The faces of runs, ascending. */
export function facesOfRuns(runs: readonly (readonly [first: number, count: number])[]): Uint32Array {
  const faces = new Uint32Array(runs.reduce((total, [, count]) => total + count, 0));
  let n = 0;
  for (const [first, count] of runs)
    for (let face = first; face < first + count; face += 1) faces[n++] = face;
  return faces;
}

/** Runs of the faces whose label differs, with their label in `after`. */
export function changedRuns(before: Uint16Array, after: Uint16Array): LabelRuns {
  const starts: number[] = [];
  const counts: number[] = [];
  let end = 0; // of the run going on
  for (let face = 0; face < after.length; face += 1) {
    if (before[face] === after[face]) continue;
    const isGoingOn = starts.length > 0 && face === end && after[face] === after[face - 1];
    if (isGoingOn) counts.push((counts.pop() as number) + 1);
    else {
      starts.push(face);
      counts.push(1);
    }
    end = face + 1;
  }
  return {
    first: Uint32Array.from(starts),
    count: Uint32Array.from(counts),
    label: Uint16Array.from(starts, (face) => after[face] as number),
  };
}

/** `labels` with the runs written over them, a new array. */
export function withRuns(labels: Uint16Array, { first, count, label }: LabelRuns): Uint16Array {
  const after = labels.slice();
  first.forEach((face, run) => {
    after.fill(label[run] as number, face, face + (count[run] as number));
  });
  return after;
}
