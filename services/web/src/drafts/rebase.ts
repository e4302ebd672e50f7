/** Strokes put on top of a log that they were not made on: each as the faces that it changed. */
import { makeDelta } from "../labels/deltaCodec";
import { runsOf } from "../labels/faceRuns";
import type { Change, LabelEditor } from "../labels/labelEditor";
import type { Edit } from "../labels/operations";
import { readOperation } from "../labels/strokeReading";
import { newStroke, type StrokeJson, type StrokePlace } from "../labels/strokes";

/**
 * New strokes that give `there` what `mine` changed in `here`; both editors are changed on the way.
 *
 * Paint and regions depend on the labels that they meet, so doing them again could take other faces than the person saw.
 * What was undone within `mine` is left out, and what changes nothing on top is no stroke.
 *
 * here : labels as they were before `mine`. there : labels after the log that they shall follow on. known : the label to
 * give for one that was given then, whose part may have gone.
 */
export async function onTop(
  here: LabelEditor,
  mine: readonly StrokeJson[],
  there: LabelEditor,
  place: StrokePlace,
  known: (label: number) => number = (label) => label,
): Promise<StrokeJson[]> {
  const strokes: StrokeJson[] = [];
  for (const { faces, after } of await netChanges(here, mine)) {
    const edit = await editOf(
      faces,
      after.map((label) => known(label)),
      there.labels,
    );
    if (there.apply(edit).faces.length === 0) continue;
    strokes.push(newStroke(edit, { ...place, sequence: place.sequence + strokes.length }));
  }
  return strokes;
}

async function netChanges(here: LabelEditor, mine: readonly StrokeJson[]): Promise<Change[]> {
  const operations = await Promise.all(mine.map(readOperation));
  const done: Change[] = [];
  const undone: Change[] = [];
  for (const operation of operations) {
    const change = here.apply(operation);
    if (change.faces.length === 0) continue;
    const last = operation.kind === "undo" ? done.pop() : undefined;
    if (last !== undefined) undone.push(last);
    else done.push(change); // also undo of what came before `mine`, which no undo on top would find
    if (operation.kind === "redo") undone.pop();
    else if (operation.kind !== "undo") undone.length = 0;
  }
  return done;
}

async function editOf(faces: Uint32Array, after: Uint16Array, labels: Uint16Array): Promise<Edit> {
  const [label] = after;
  if (label !== undefined && after.every((each) => each === label)) {
    return { kind: "assign", runs: runsOf(faces), label };
  }
  const wanted = labels.slice();
  faces.forEach((face, place) => {
    wanted[face] = after[place] as number;
  });
  return makeDelta("start_from", { from: "own strokes" }, labels, wanted);
}
