/**
 * What an annotator can do to a shape's labels, named as in the JSON of strokes (docs/segmentation.md).
 *
 * An operation in hand is its JSON, but that a delta also carries what its payload holds, so that doing it waits for
 * nothing.
 */
import type { LabelRuns } from "./faceRuns";

export type Scalar = string | number | boolean | null;
export type DeltaSource = "patches" | "boundary_refinement" | "model_refinement" | "start_from";

/** A click or a drag with the brush. `only_over`: the part of the only faces that may be taken or crossed; null for all. */
export interface Paint {
  readonly kind: "paint";
  readonly seeds: readonly number[];
  readonly radius: number;
  readonly min_cosine: number | null;
  readonly label: number;
  readonly only_over: number | null;
}

/** Given faces get `label`. runs : [first face, count], ascending, not overlapping. */
export interface Assign {
  readonly kind: "assign";
  readonly runs: readonly (readonly [first: number, count: number])[];
  readonly label: number;
}

/** The connected region of equal label around `seed` gets `label`. */
export interface SegmentWide {
  readonly kind: "segment_wide";
  readonly seed: number;
  readonly label: number;
}

/** What a solver made, as a difference. payload : base64 of zlib; sha256 : of all labels afterwards. */
export interface DeltaJson {
  readonly kind: "delta";
  readonly source: DeltaSource;
  readonly parameters: Readonly<Record<string, Scalar>>;
  readonly n_faces: number;
  readonly n_runs: number;
  readonly payload: string;
  readonly sha256: string;
}

/** A delta with its payload read. */
export interface Delta extends DeltaJson {
  readonly changed: LabelRuns;
}

export interface Clear {
  readonly kind: "clear";
}

export interface Undo {
  readonly kind: "undo";
}

export interface Redo {
  readonly kind: "redo";
}

/** What may change labels and then is one step for undo. */
export type Edit = Paint | Assign | SegmentWide | Delta | Clear;
export type Operation = Edit | Undo | Redo;
export type OperationJson = Paint | Assign | SegmentWide | DeltaJson | Clear | Undo | Redo;

/** A part id is 1 to this; 0 is unlabelled. */
export const MAX_PART_ID = 65_535;
export const UNLABELLED = 0;
