/** Strokes and logs from JSON, of this version or an older one. What is missing, unknown or mistyped is refused. */
import { readDelta } from "./deltaCodec";
import { StrokeFormatError } from "./errors";
import { JsonFields } from "./jsonFields";
import type { DeltaSource, Operation, OperationJson, Scalar } from "./operations";
import { STROKE_VERSION, type StrokeJson } from "./strokes";
import { upgradedLog, upgradedStroke } from "./strokeVersions";

const DELTA_SOURCES: readonly string[] = ["patches", "boundary_refinement", "model_refinement", "start_from"];

export interface StrokeLog {
  readonly mesh_hash: string;
  readonly n_faces: number;
  readonly base_revision: number | null;
  readonly base_sha256: string;
  readonly strokes: readonly StrokeJson[];
}

/** Throws StrokeFormatError. */
export function readStroke(document: unknown): StrokeJson {
  const fields = new JsonFields(upgradedStroke(document), "a stroke");
  fields.whole("v");
  const stroke: StrokeJson = {
    v: STROKE_VERSION,
    ...readOperationJson(fields),
    id: fields.text("id"),
    sequence: fields.whole("sequence"),
    base_revision: fields.orNull("base_revision", (key) => fields.whole(key)),
    author_id: fields.whole("author_id"),
    at: fields.text("at"),
  };
  fields.checkAllRead();
  return stroke;
}

/** Throws StrokeFormatError. */
export function readLog(document: unknown): StrokeLog {
  const fields = new JsonFields(upgradedLog(document), "a stroke log");
  if (fields.text("format") !== "partwise strokes") throw new StrokeFormatError("this is no stroke log");
  fields.whole("v");
  const log = {
    mesh_hash: fields.text("mesh_hash"),
    n_faces: fields.whole("n_faces"),
    base_revision: fields.orNull("base_revision", (key) => fields.whole(key)),
    base_sha256: fields.text("base_sha256"),
    strokes: fields.list("strokes").map(readStroke),
  };
  fields.checkAllRead();
  return log;
}

/** The operation of a stroke, ready to be done. Throws LabelError on a delta that is damaged. */
export async function readOperation(stroke: OperationJson): Promise<Operation> {
  return stroke.kind === "delta" ? readDelta(stroke) : stroke;
}

function readOperationJson(fields: JsonFields): OperationJson {
  const kind = fields.text("kind");
  switch (kind) {
    case "paint":
      return {
        kind,
        seeds: fields.wholes("seeds"),
        radius: fields.number("radius"),
        min_cosine: fields.orNull("min_cosine", (key) => fields.number(key)),
        label: fields.whole("label"),
        only_over: fields.orNull("only_over", (key) => fields.whole(key)),
      };
    case "assign":
      return { kind, runs: fields.wholePairs("runs"), label: fields.whole("label") };
    case "segment_wide":
      return { kind, seed: fields.whole("seed"), label: fields.whole("label") };
    case "delta":
      return {
        kind,
        source: readSource(fields.text("source")),
        parameters: fields.object("parameters") as Record<string, Scalar>,
        n_faces: fields.whole("n_faces"),
        n_runs: fields.whole("n_runs"),
        payload: fields.text("payload"),
        sha256: fields.text("sha256"),
      };
    case "clear":
    case "undo":
    case "redo":
      return { kind };
    default:
      throw new StrokeFormatError(`a stroke's kind ${kind} is not known here; reload the page`);
  }
}

function readSource(source: string): DeltaSource {
  if (!DELTA_SOURCES.includes(source))
    throw new StrokeFormatError(`a delta's source ${source} is not known here`);
  return source as DeltaSource;
}
