/** A stroke log replayed: the same labels on every machine, by the same code as live editing. */
import type { SurfaceMesh } from "../geometry/surfaceMesh";
import { LabelError } from "./errors";
import { LabelEditor } from "./labelEditor";
import { labelsSha256 } from "./sha256";
import { readOperation, type StrokeLog } from "./strokeReading";
import type { StrokeJson } from "./strokes";

/**
 * An editor as it was after the log's last stroke, undo and all.
 *
 * Throws LabelError: a log of another mesh or from other labels, or a stroke that cannot be done; the message says which.
 */
export async function replayedLog(
  mesh: SurfaceMesh,
  baseLabels: Uint16Array,
  log: StrokeLog,
): Promise<LabelEditor> {
  if (mesh.hash !== log.mesh_hash || mesh.nFaces !== log.n_faces) {
    throw new LabelError("a stroke log must be replayed on its own mesh, but this is another one");
  }
  if (labelsSha256(baseLabels) !== log.base_sha256) {
    throw new LabelError(`a stroke log must start from its own labels; fetch revision ${log.base_revision}`);
  }
  const editor = new LabelEditor(mesh, baseLabels);
  await replayOnto(editor, log.strokes);
  return editor;
}

/** Does strokes in order. Throws LabelError at the first that cannot be done; those before it are done by then. */
export async function replayOnto(editor: LabelEditor, strokes: readonly StrokeJson[]): Promise<void> {
  const operations = await Promise.all(strokes.map(readOperation)); // all payloads first: then nothing comes between
  for (const [place, operation] of operations.entries()) {
    try {
      editor.apply(operation);
    } catch (error) {
      const why = error instanceof Error ? error.message : String(error);
      throw new LabelError(`stroke ${strokes[place]?.sequence} of the log cannot be replayed: ${why}`);
    }
  }
}
