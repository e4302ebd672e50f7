/** A shape in hand: its labels under edit, shown by a model, recorded by a draft. */

import type { DraftSession } from "../../../drafts/draftSession";
import type { Lease } from "../../../drafts/leaseApi";
import { Observable } from "../../../drafts/observable";
import { onTop } from "../../../drafts/rebase";
import { makeDelta } from "../../../labels/deltaCodec";
import { type Change, LabelEditor } from "../../../labels/labelEditor";
import type { DeltaSource, Operation, Scalar } from "../../../labels/operations";
import { replayOnto } from "../../../labels/replay";
import { readOperation } from "../../../labels/strokeReading";
import { newStroke, type StrokeJson } from "../../../labels/strokes";
import type { ShapeModel } from "../../../viewer/shapeModel";

export type Draft = DraftSession<Lease>;

export class OpenShape {
  /** Counts changes of the labels, for what is computed from them. */
  readonly version = new Observable(0);
  /** Labels that the person last set, which refining again stays near; null if they are those at hand. */
  anchor: Uint16Array | null = null;
  /** As the shape was when it was opened. */
  readonly opened: Uint16Array;

  private constructor(
    readonly model: ShapeModel,
    readonly draft: Draft,
    private readonly base: Uint16Array,
    private current: LabelEditor,
    private partIds: readonly number[] | null,
  ) {
    this.opened = current.labels.slice();
    model.setLabels(current.labels);
    draft.listener = {
      onReplaced: () => void this.rebuild(),
      onFollowed: (stroke) => void this.follow(stroke),
    };
  }

  static async open(
    model: ShapeModel,
    draft: Draft,
    base: Uint16Array | null,
    partIds: readonly number[] | null,
  ): Promise<OpenShape> {
    const start = base ?? new Uint16Array(model.mesh.nFaces);
    const shape = new OpenShape(model, draft, start, await edited(model, start, draft.strokes), partIds);
    await shape.restoreAnchor();
    shape.setParts(partIds);
    return shape;
  }

  get editor(): LabelEditor {
    return this.current;
  }

  get labels(): Uint16Array {
    return this.current.labels;
  }

  /** Whether a person may change something: this tab edits, and there is no conflict to settle first. */
  get canEdit(): boolean {
    const { kind } = this.draft.sender.state.get();
    return this.draft.canEdit && kind !== "conflict" && kind !== "closed" && kind !== "refused";
  }

  /** From now on, strokes may only give these parts; null while they are not known. */
  setParts(partIds: readonly number[] | null): void {
    this.partIds = partIds;
    this.current.restrictTo(partIds);
  }

  /** Does an operation, records and shows it; null where it changed nothing, which is not recorded. */
  perform(operation: Operation): Change | null {
    if (!this.canEdit) return null;
    const { place } = this.draft;
    const change = this.current.apply(operation);
    if (change.faces.length === 0) return null;
    this.draft.append(newStroke(operation, place));
    if (!isBoundaryRefinement(operation)) this.anchor = null;
    this.model.recolour(change.faces);
    this.version.set(this.version.get() + 1);
    return change;
  }

  undo(): void {
    if (this.current.canUndo) this.perform({ kind: "undo" });
  }

  redo(): void {
    if (this.current.canRedo) this.perform({ kind: "redo" });
  }

  /** Takes labels that a solver made, as one step. False if strokes came in between, so that they no longer fit. */
  async replaceLabels(
    source: DeltaSource,
    parameters: Readonly<Record<string, Scalar>>,
    labels: Uint16Array,
    madeAt: number = this.version.get(),
  ): Promise<boolean> {
    if (this.version.get() !== madeAt) return false;
    const before = this.labels.slice();
    const delta = await makeDelta(source, parameters, before, labels);
    if (this.version.get() !== madeAt) return false;
    if (source === "boundary_refinement") this.anchor ??= before;
    this.perform(delta);
    return true;
  }

  /** Settles a conflict: strokes made here are put on top of those on record. */
  async keepMine(): Promise<void> {
    const state = this.draft.sender.state.get();
    if (state.kind !== "conflict") return;
    const { common, mine, theirs } = state.divergence;
    const before = this.draft.strokes.slice(0, common);
    const [here, there] = await Promise.all([
      edited(this.model, this.base, before),
      edited(this.model, this.base, [...before, ...theirs]),
    ]);
    const place = { ...this.draft.place, sequence: common + theirs.length };
    await this.draft.sender.keepMine(await onTop(here, mine, there, place));
  }

  /** Strokes that were set aside earlier, as new ones on top. `first` : how many of this log came before them. */
  async putOnTop(first: number, strokes: readonly StrokeJson[]): Promise<void> {
    const here = await edited(this.model, this.base, this.draft.strokes.slice(0, first));
    const there = await edited(this.model, this.base, this.draft.strokes);
    for (const stroke of await onTop(here, strokes, there, this.draft.place)) {
      this.perform(await readOperation(stroke));
    }
  }

  /** Labels of both sides of a conflict, to be looked at. */
  async sidesOfConflict(): Promise<{ mine: Uint16Array; theirs: Uint16Array } | null> {
    const state = this.draft.sender.state.get();
    if (state.kind !== "conflict") return null;
    const { common, theirs } = state.divergence;
    const theirLog = [...this.draft.strokes.slice(0, common), ...theirs];
    return { mine: this.labels, theirs: (await edited(this.model, this.base, theirLog)).labels };
  }

  /** Leaves the shape. Strokes stay on record or in the outbox. */
  async close(): Promise<void> {
    await this.draft.close();
    this.model.dispose();
  }

  private async rebuild(): Promise<void> {
    this.current = await edited(this.model, this.base, this.draft.strokes);
    this.current.restrictTo(this.partIds);
    this.anchor = null;
    this.model.setLabels(this.current.labels);
    this.version.set(this.version.get() + 1);
  }

  private async follow(stroke: StrokeJson): Promise<void> {
    const operation = await readOperation(stroke);
    this.current.restrictTo(null); // the other tab may know of newer parts
    const change = this.current.apply(operation);
    this.current.restrictTo(this.partIds);
    this.model.recolour(change.faces);
    this.version.set(this.version.get() + 1);
  }

  /** After a reload, refining goes on from the labels that the person had set before they refined. */
  private async restoreAnchor(): Promise<void> {
    const { strokes } = this.draft;
    const last = strokes.findLastIndex((stroke) => !isBoundaryRefinement(stroke));
    if (last === strokes.length - 1) return;
    this.anchor = (await edited(this.model, this.base, strokes.slice(0, last + 1))).labels;
  }
}

async function edited(
  model: ShapeModel,
  base: Uint16Array,
  strokes: readonly StrokeJson[],
): Promise<LabelEditor> {
  const editor = new LabelEditor(model.mesh, base);
  await replayOnto(editor, strokes);
  return editor;
}

function isBoundaryRefinement(operation: { readonly kind: string; readonly source?: unknown }): boolean {
  return operation.kind === "delta" && operation.source === "boundary_refinement";
}
