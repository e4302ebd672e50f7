/** An operation that does not fit the labels: of another mesh, of a part that is not there, damaged. Nothing changed. */
export class LabelError extends Error {
  override readonly name = "LabelError";
}

/** Strokes or logs that are not as docs/segmentation.md says, or are of a newer version. */
export class StrokeFormatError extends Error {
  override readonly name = "StrokeFormatError";
}
