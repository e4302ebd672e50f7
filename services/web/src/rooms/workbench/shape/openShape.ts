/** A shape in hand: its labels under edit, shown by a model, recorded by a draft. */

import type { ConfirmOutcome } from "../../../drafts/confirming";
import type { DraftSession } from "../../../drafts/draftSession";
import type { Lease } from "../../../drafts/leaseApi";
import { Observable } from "../../../drafts/observable";
import type { SetAside } from "../../../drafts/outbox";
import { onTop } from "../../../drafts/rebase";
import { makeDelta } from "../../../labels/deltaCodec";
import { type Change, LabelEditor } from "../../../labels/labelEditor";
import { type DeltaSource, type Operation, type Scalar, UNLABELLED } from "../../../labels/operations";
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
  opened: Uint16Array;
  /** From the moment that the person confirms the labels, until it is known that they are not confirmed. */
  readonly isConfirming = new Observable(false);
  /** The log has strokes that the labels do not: what is done now would not follow on it. */
  readonly isBehind = new Observable(true);

  private current: LabelEditor;
  /** How many strokes of the log the labels have. */
  private nDone = 0;
  /** Another log came: labels are made from its first stroke on. */
  private isLogAnother = true;
  private isCatchingUp = false;

  private constructor(
    readonly model: ShapeModel,
    readonly draft: Draft,
    private readonly base: Uint16Array,
    private partIds: readonly number[] | null,
  ) {
    this.opened = base;
    this.current = new LabelEditor(model.mesh, base);
    draft.listener = {
      onReplaced: () => {
        this.isLogAnother = true;
        void this.catchUp();
      },
      onFollowed: () => void this.catchUp(),
    };
  }

  static async open(
    model: ShapeModel,
    draft: Draft,
    base: Uint16Array | null,
    partIds: readonly number[] | null,
  ): Promise<OpenShape> {
    const start = base ?? new Uint16Array(model.mesh.nFaces);
    const shape = new OpenShape(model, draft, start, partIds);
    await shape.catchUp();
    shape.opened = shape.labels.slice();
    await shape.restoreAnchor();
    return shape;
  }

  get editor(): LabelEditor {
    return this.current;
  }

  get labels(): Uint16Array {
    return this.current.labels;
  }

  /** Whether a person may change something: this tab edits, nothing is to be settled first, and it is not over. */
  get canEdit(): boolean {
    const { kind } = this.draft.sender.state.get();
    const isSettled = kind !== "conflict" && kind !== "closed" && kind !== "refused";
    const isOver = this.isConfirming.get() || this.draft.isConfirmedElsewhere.get();
    const isBehind = this.isBehind.get() || this.nDone !== this.draft.strokes.length;
    return this.draft.canEdit && isSettled && !isOver && !isBehind;
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
    this.nDone += 1;
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

  /** Confirms the labels as they are: none are changed meanwhile, nor once it is done. */
  async confirm(): Promise<ConfirmOutcome> {
    this.isConfirming.set(true);
    let isDone = false;
    try {
      const outcome = await this.draft.confirm(this.editor.sha256());
      isDone = outcome.kind === "confirmed";
      return outcome;
    } finally {
      this.isConfirming.set(isDone);
    }
  }

  /** Takes labels to start from as the first step. They show at once. */
  async startFrom(from: string, labels: Uint16Array): Promise<void> {
    if (labels.length === this.labels.length) this.model.setLabels(labels);
    try {
      await this.replaceLabels("start_from", { from }, labels);
    } finally {
      this.model.setLabels(this.labels);
    }
  }

  /**
   * Takes labels that a solver made, as one step; a part that the collection no longer has is given to no face. False if
   * strokes came in between, so that they no longer fit, or if nothing may be changed now.
   */
  async replaceLabels(
    source: DeltaSource,
    parameters: Readonly<Record<string, Scalar>>,
    labels: Uint16Array,
    madeAt: number = this.version.get(),
  ): Promise<boolean> {
    if (this.version.get() !== madeAt) return false;
    const before = this.labels.slice();
    const given = labels.map((label, face) => (label === before[face] ? label : this.known(label)));
    const delta = await makeDelta(source, parameters, before, given);
    if (this.version.get() !== madeAt || !this.canEdit) return false;
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
    await this.draft.sender.keepMine(await onTop(here, mine, there, place, (label) => this.known(label)));
  }

  /**
   * Strokes that were set aside, of this draft or an earlier one, as new ones on top: all of them, or none and it rejects.
   *
   * base : (m) labels that their draft started from; null for all unlabelled.
   */
  async putOnTop({ before, strokes }: SetAside, base: Uint16Array | null): Promise<void> {
    const madeAt = this.version.get();
    const here = await edited(this.model, base ?? new Uint16Array(this.base.length), before);
    const there = await edited(this.model, this.base, this.draft.strokes);
    const put = await onTop(here, strokes, there, this.draft.place, (label) => this.known(label));
    const operations = await Promise.all(put.map(readOperation)); // all payloads first: then nothing comes between
    if (!this.canEdit || this.version.get() !== madeAt) {
      throw new Error("The labels changed meanwhile, so nothing was put on top. Try again.");
    }
    for (const operation of operations) this.perform(operation);
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

  /** One stroke after the other, whatever comes meanwhile. A log that cannot be done here is not drawn on either. */
  private async catchUp(): Promise<void> {
    if (this.isCatchingUp) return;
    this.isCatchingUp = true;
    this.isBehind.set(true);
    try {
      while (this.isLogAnother || this.nDone < this.draft.strokes.length) {
        await (this.isLogAnother ? this.rebuild() : this.follow());
      }
      this.isBehind.set(false);
    } finally {
      this.isCatchingUp = false;
    }
  }

  private async rebuild(): Promise<void> {
    this.isLogAnother = false;
    const strokes = [...this.draft.strokes];
    const rebuilt = await edited(this.model, this.base, strokes).catch((error: unknown) => {
      this.isLogAnother = true;
      throw error;
    });
    if (this.isLogAnother) return; // and another one again
    this.current = rebuilt;
    this.current.restrictTo(this.partIds);
    this.nDone = strokes.length;
    this.anchor = null;
    this.model.setLabels(this.current.labels);
    this.version.set(this.version.get() + 1);
  }

  private async follow(): Promise<void> {
    const operation = await readOperation(this.draft.strokes[this.nDone] as StrokeJson);
    if (this.isLogAnother) return;
    this.current.restrictTo(null); // the other tab may know of newer parts
    const change = this.current.apply(operation);
    this.current.restrictTo(this.partIds);
    this.nDone += 1;
    this.model.recolour(change.faces);
    this.version.set(this.version.get() + 1);
  }

  /** The label, or none where it is of a part that the collection no longer has. */
  private known(label: number): number {
    return this.partIds === null || this.partIds.includes(label) ? label : UNLABELLED;
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
