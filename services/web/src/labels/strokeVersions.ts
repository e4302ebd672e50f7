/** Older versions of strokes and logs made new, as `partwise.labels.stroke_versions`: each step one version further. */
import { StrokeFormatError } from "./errors";
import { runsOf } from "./faceRuns";
import { JsonFields, type JsonObject } from "./jsonFields";
import { labelsSha256 } from "./sha256";
import { STROKE_VERSION } from "./strokes";

type Step = (document: JsonObject) => JsonObject;

export function upgradedStroke(document: unknown): JsonObject {
  return upgraded(document, "a stroke", [strokeFromV0]);
}

export function upgradedLog(document: unknown): JsonObject {
  return upgraded(document, "a stroke log", [logFromV0]);
}

function upgraded(document: unknown, what: string, steps: readonly Step[]): JsonObject {
  let version = new JsonFields(document, what).whole("v");
  let current = document as JsonObject;
  for (let step = steps[version]; step !== undefined; step = steps[version]) {
    current = step(current);
    version += 1;
  }
  if (version !== STROKE_VERSION) {
    throw new StrokeFormatError(
      `${what} must have version 0 to ${STROKE_VERSION} but has ${version}; reload the page`,
    );
  }
  return current;
}

/** Version 0 had the radius in model units beside the diagonal, one seed, no angle limit, and faces one by one. */
function strokeFromV0(document: JsonObject): JsonObject {
  const fields = new JsonFields(document, "a stroke of version 0");
  const kind = fields.text("kind");
  if (kind === "paint") {
    const { diagonal: _, seed: __, ...rest } = document;
    const radius = Math.min(fields.number("radius") / fields.number("diagonal"), 1);
    const seeds = [fields.whole("seed")];
    return { ...rest, v: 1, base_revision: null, seeds, radius, min_cosine: null, only_over: null };
  }
  if (kind === "assign") {
    const { faces: _, ...rest } = document;
    return { ...rest, v: 1, base_revision: null, runs: runsOf(fields.wholes("faces")) };
  }
  return { ...document, v: 1, base_revision: null };
}

/** Logs of version 0 always began with every face unlabelled. */
function logFromV0(document: JsonObject): JsonObject {
  const nFaces = new JsonFields(document, "a stroke log of version 0").whole("n_faces");
  return { ...document, v: 1, base_revision: null, base_sha256: labelsSha256(new Uint16Array(nFaces)) };
}
