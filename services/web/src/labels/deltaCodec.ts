/** Differences of labels in the form that strokes keep them: base64 of a zlib stream of runs. */
import { LabelError } from "./errors";
import { changedRuns, type LabelRuns } from "./faceRuns";
import type { Delta, DeltaJson, DeltaSource, Scalar } from "./operations";
import { labelsSha256 } from "./sha256";

const RUN_BYTES = 10; // u32 first face, u32 count, u16 label

/** The delta that turns `before` into `after`. Throws LabelError when the two differ in length. */
export async function makeDelta(
  source: DeltaSource,
  parameters: Readonly<Record<string, Scalar>>,
  before: Uint16Array,
  after: Uint16Array,
): Promise<Delta> {
  if (before.length !== after.length) {
    throw new LabelError(`labels must be of one mesh but are of ${before.length} and ${after.length} faces`);
  }
  const changed = changedRuns(before, after);
  const sha256 = labelsSha256(after); // before waiting: the caller may go on editing `after`
  const n_faces = after.length;
  const payload = base64(await piped(runBytes(changed), new CompressionStream("deflate")));
  return {
    kind: "delta",
    source,
    parameters,
    n_faces,
    n_runs: changed.first.length,
    payload,
    sha256,
    changed,
  };
}

/** The delta with its payload read. Throws LabelError on a damaged one. */
export async function readDelta(delta: DeltaJson): Promise<Delta> {
  const { kind, source, parameters, n_faces, n_runs, payload, sha256 } = delta;
  const nBytes = RUN_BYTES * n_runs;
  const raw = await inflated(payload, nBytes);
  if (raw.length !== nBytes) throw damaged(`must hold ${n_runs} runs but does not`);
  return {
    kind,
    source,
    parameters,
    n_faces,
    n_runs,
    payload,
    sha256,
    changed: runsOfBytes(raw, n_runs, n_faces),
  };
}

/** A delta as its JSON: without what its payload says anyway. */
export function deltaJson({ changed: _, ...json }: Delta): DeltaJson {
  return json;
}

function runBytes({ first, count, label }: LabelRuns): Uint8Array<ArrayBuffer> {
  const n = first.length;
  const view = new DataView(new ArrayBuffer(RUN_BYTES * n));
  for (let run = 0; run < n; run += 1) {
    view.setUint32(4 * run, first[run] as number, true);
    view.setUint32(4 * (n + run), count[run] as number, true);
    view.setUint16(8 * n + 2 * run, label[run] as number, true);
  }
  return new Uint8Array(view.buffer);
}

function runsOfBytes(raw: Uint8Array, n: number, nFaces: number): LabelRuns {
  const view = new DataView(raw.buffer, raw.byteOffset);
  const first = Uint32Array.from({ length: n }, (_, run) => view.getUint32(4 * run, true));
  const count = Uint32Array.from({ length: n }, (_, run) => view.getUint32(4 * (n + run), true));
  const label = Uint16Array.from({ length: n }, (_, run) => view.getUint16(8 * n + 2 * run, true));
  let end = 0;
  for (let run = 0; run < n; run += 1) {
    if (count[run] === 0 || (first[run] as number) < end) throw damaged("'s runs must ascend but do not");
    end = (first[run] as number) + (count[run] as number);
  }
  if (end > nFaces) throw damaged(`'s runs must end within ${nFaces} faces but do not`);
  return { first, count, label };
}

/** At most one byte more than `nBytes`, so that a small payload cannot fill the memory. */
async function inflated(payload: string, nBytes: number): Promise<Uint8Array> {
  let bytes: Uint8Array<ArrayBuffer>;
  try {
    bytes = Uint8Array.from(atob(payload), (character) => character.charCodeAt(0));
  } catch {
    throw damaged("must be base64 but is not");
  }
  try {
    return await piped(bytes, new DecompressionStream("deflate"), nBytes);
  } catch (error) {
    throw damaged(`must be zlib but: ${error instanceof Error ? error.message : error}`);
  }
}

async function piped(
  bytes: Uint8Array<ArrayBuffer>,
  transform: CompressionStream | DecompressionStream,
  most = Number.POSITIVE_INFINITY,
): Promise<Uint8Array> {
  const reader = new Blob([bytes]).stream().pipeThrough(transform).getReader();
  const chunks: Uint8Array[] = [];
  let total = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    chunks.push(part.value);
    total += part.value.length;
    if (total > most) {
      await reader.cancel();
      break;
    }
  }
  const joined = new Uint8Array(total);
  let at = 0;
  for (const chunk of chunks) {
    joined.set(chunk, at);
    at += chunk.length;
  }
  return joined;
}

function base64(bytes: Uint8Array): string {
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text);
}

function damaged(what: string): LabelError {
  return new LabelError(`a label delta ${what}; reload the shape`.replace("delta '", "delta'"));
}
