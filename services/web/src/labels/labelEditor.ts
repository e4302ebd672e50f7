/**
 * Labels of one shape under edit, with undo: operations mean what `partwise.labels.replay` makes of them.
 *
 * An edit that changes no face is no step: undo passes it over and redo stays as it was. At most `UNDO_LIMIT` steps can
 * be taken back; undo and redo without a step change nothing. That is part of what a log means. What is refused changes
 * nothing either.
 */
import { type Brush, paintedFaces } from "../geometry/paint";
import { regionOf } from "../geometry/region";
import type { SurfaceMesh } from "../geometry/surfaceMesh";
import { LabelError } from "./errors";
import { facesOfRuns, withRuns } from "./faceRuns";
import {
  type Assign,
  type Delta,
  type Edit,
  MAX_PART_ID,
  type Operation,
  type Paint,
  UNLABELLED,
} from "./operations";
import { labelsSha256 } from "./sha256";

const UNDO_LIMIT = 200;

/** Faces, ascending, whose label changed, with their labels before and after. Not to be written to: undo holds them. */
export interface Change {
  readonly faces: Uint32Array;
  readonly before: Uint16Array;
  readonly after: Uint16Array;
}

const NOTHING: Change = { faces: new Uint32Array(), before: new Uint16Array(), after: new Uint16Array() };

export class LabelEditor {
  readonly mesh: SurfaceMesh;
  readonly #labels: Uint16Array;
  #partIds: ReadonlySet<number> | null = null;
  #done: Change[] = [];
  #undone: Change[] = [];

  /** labels : (m) part ids, 0 = unlabelled; copied. Throws LabelError when they are not one per face. */
  constructor(mesh: SurfaceMesh, labels: Uint16Array) {
    if (labels.length !== mesh.nFaces) {
      throw new LabelError(
        `there must be one label per face but there are ${labels.length} for ${mesh.nFaces} faces`,
      );
    }
    this.mesh = mesh;
    this.#labels = labels.slice();
  }

  /** The labels now: one array for the editor's life, which follows later operations. Not to be written to. */
  get labels(): Uint16Array {
    return this.#labels;
  }

  get canUndo(): boolean {
    return this.#done.length > 0;
  }

  get canRedo(): boolean {
    return this.#undone.length > 0;
  }

  /** Checksum of the labels now, as the service computes it. */
  sha256(): string {
    return labelsSha256(this.#labels);
  }

  /** From now on, edits may only give these parts, and 0. Undo and redo still bring back what was there. */
  restrictTo(partIds: Iterable<number> | null): void {
    this.#partIds = partIds === null ? null : new Set([UNLABELLED, ...partIds]);
  }

  /**
   * Does one operation and says what changed; what changed nothing must not be recorded as a stroke.
   *
   * Throws RangeError (a face outside the mesh), LabelError (a part that may not be given, a delta that does not fit).
   */
  apply(operation: Operation): Change {
    if (operation.kind === "undo") return this.#stepBack();
    if (operation.kind === "redo") return this.#stepForward();
    const change = this.preview(operation);
    if (change.faces.length > 0) {
      this.#write(change.faces, change.after);
      this.#done.push(change);
      if (this.#done.length > UNDO_LIMIT) this.#done.shift();
      this.#undone = [];
    }
    return change;
  }

  /** What the edit would change; nothing is changed. Throws as `apply`. */
  preview(edit: Edit): Change {
    switch (edit.kind) {
      case "paint":
        return this.#relabelled(this.#painted(edit), this.#checkedPart(edit.label));
      case "assign":
        return this.#relabelled(this.#assigned(edit), this.#checkedPart(edit.label));
      case "segment_wide":
        return this.#relabelled(
          regionOf(this.mesh.graph, this.#labels, edit.seed),
          this.#checkedPart(edit.label),
        );
      case "clear":
        return this.#relabelled(Uint32Array.from(this.#labels.keys()), UNLABELLED);
      case "delta":
        return this.#differing(edit);
    }
  }

  #stepBack(): Change {
    const change = this.#done.pop();
    if (change === undefined) return NOTHING;
    this.#undone.push(change);
    this.#write(change.faces, change.before);
    return { faces: change.faces, before: change.after, after: change.before };
  }

  #stepForward(): Change {
    const change = this.#undone.pop();
    if (change === undefined) return NOTHING;
    this.#done.push(change);
    this.#write(change.faces, change.after);
    return change;
  }

  #write(faces: Uint32Array, labels: Uint16Array): void {
    for (let place = 0; place < faces.length; place += 1) {
      this.#labels[faces[place] as number] = labels[place] as number;
    }
  }

  #painted({ seeds, radius, min_cosine, only_over }: Paint): Uint32Array {
    const brush: Brush = { radius, min_cosine };
    return paintedFaces(
      this.mesh,
      seeds,
      brush,
      only_over === null ? undefined : isOf(this.#labels, only_over),
    );
  }

  #assigned({ runs }: Assign): Uint32Array {
    const [first, count] = runs.at(-1) ?? [0, 0];
    this.mesh.graph.checkFace(first + count - 1);
    return facesOfRuns(runs);
  }

  #differing({ n_faces, changed, sha256 }: Delta): Change {
    if (n_faces !== this.#labels.length) {
      throw new LabelError(
        `a delta for ${n_faces} faces must not be applied to ${this.#labels.length}; another mesh?`,
      );
    }
    const after = withRuns(this.#labels, changed);
    if (labelsSha256(after) !== sha256) {
      throw new LabelError(
        "labels after a delta must have its checksum; it is damaged, or made for other labels",
      );
    }
    const faces = Uint32Array.from(after.keys()).filter((face) => after[face] !== this.#labels[face]);
    const labels = Uint16Array.from(faces, (face) => after[face] as number);
    for (const label of new Set(labels)) this.#checkedPart(label);
    return { faces, before: this.#labelsOf(faces), after: labels };
  }

  #relabelled(taken: Uint32Array, label: number): Change {
    const faces = taken.filter((face) => this.#labels[face] !== label);
    return { faces, before: this.#labelsOf(faces), after: new Uint16Array(faces.length).fill(label) };
  }

  #labelsOf(faces: Uint32Array): Uint16Array {
    return Uint16Array.from(faces, (face) => this.#labels[face] as number);
  }

  #checkedPart(label: number): number {
    const isKnown = this.#partIds === null ? label >= 0 && label <= MAX_PART_ID : this.#partIds.has(label);
    if (!isKnown) throw new LabelError(`a label must be a part of the collection, or 0, but is ${label}`);
    return label;
  }
}

function isOf(labels: Uint16Array, label: number): (face: number) => boolean {
  return (face) => labels[face] === label;
}
