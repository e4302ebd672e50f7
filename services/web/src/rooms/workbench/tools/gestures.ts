/** What a press, a drag and hovering on the surface mean with the tool in hand. */
import { type Brush, clickedFaces, cosineOfLimit, Drag } from "../../../geometry/paint";
import { regionOf } from "../../../geometry/region";
import { runsOf } from "../../../labels/faceRuns";
import type { Operation, Paint } from "../../../labels/operations";
import type { ViewListener } from "../../../viewer/gesturedView";
import type { Hit, ShapeModel } from "../../../viewer/shapeModel";
import type { ShapeView } from "../../../viewer/shapeView";
import type { OpenShape } from "../shape/openShape";
import type { PatchMap } from "./patchMap";
import type { ToolSettings, ToolShelf } from "./toolSettings";

export interface GestureContext {
  readonly shelf: ToolShelf;
  /** Whether the view shows what is drawn on, rather than something to compare it with. */
  isDrawnOn(): boolean;
  /** The shape in the view that may be worked on now; null while there is none. */
  open(): OpenShape | null;
  patches(): PatchMap | null;
  /** `#rrggbb` of a part; of 0, the grey of unlabelled faces. */
  colourOf(part: number): string;
  /** The person works in this view now. */
  onEngage(): void;
}

const SPACING = 0.25;

export class ToolGestures implements ViewListener {
  private drag: { readonly faces: Drag; readonly stroke: Omit<Paint, "seeds"> } | null = null;
  private taken: Set<number> | null = null;
  private region: { readonly faces: Uint32Array; readonly version: number } | null = null;
  /** Where the pointer rests, so that keys change what is shown there at once. */
  private pointer: { readonly hit: Hit; readonly on: ShapeModel } | null = null;

  constructor(
    private readonly view: ShapeView,
    private readonly context: GestureContext,
  ) {}

  /** Makes the view behave as the tool in hand needs it. */
  adopt(): void {
    const { tool, radius } = this.settings;
    const model = this.view.model;
    this.view.tool = tool === "turn" || !this.context.isDrawnOn() ? "navigate" : "stroke";
    this.view.strokeSpacing = tool === "paint" ? radius * SPACING : 0;
    this.region = null;
    if (tool !== "paint" || this.view.tool === "navigate") model?.setBrush(null);
    if (this.isStroking) return;
    model?.setPreview(null);
    if (this.pointer !== null && this.pointer.on === model) this.hover(this.pointer.hit);
  }

  hover(hit: Hit | null): void {
    const open = this.context.open();
    if (open === null) return;
    this.pointer = hit === null ? null : { hit, on: open.model };
    const { tool, radius } = this.settings;
    if (tool === "paint") open.model.setBrush(hit === null ? null : { point: hit.point, radius });
    if (!this.isStroking) open.model.setPreview(this.hovered(open, hit), this.colour());
  }

  strokeStart(hit: Hit): void {
    this.context.onEngage();
    const open = this.context.open();
    if (open === null || !open.canEdit) return;
    const { tool } = this.settings;
    if (tool === "paint") this.startPaint(open, hit);
    else if (tool === "patches") this.takePatches(open, [hit]);
    else if (tool === "segment")
      this.done(open, { kind: "segment_wide", seed: hit.face, label: this.settings.part });
    else if (tool === "pick")
      this.context.shelf.change({ part: open.labels[hit.face] as number, tool: "paint" });
  }

  strokeMove(hits: readonly Hit[]): void {
    const open = this.context.open();
    if (open === null) return;
    if (this.drag !== null) for (const { face } of hits) open.model.addPreview(this.drag.faces.click(face));
    else if (this.taken !== null) this.takePatches(open, hits);
  }

  strokeEnd(): void {
    const open = this.context.open();
    const { drag, taken } = this;
    this.drag = null;
    this.taken = null;
    if (open === null) return;
    open.model.setPreview(null);
    if (drag !== null) this.done(open, { ...drag.stroke, seeds: drag.faces.seeds });
    const faces = taken === null ? [] : [...taken].sort((a, b) => a - b);
    if (faces.length > 0) this.done(open, { kind: "assign", runs: runsOf(faces), label: this.settings.part });
  }

  strokeCancel(): void {
    this.drag = null;
    this.taken = null;
    this.context.open()?.model.setPreview(null);
  }

  /** One press in the middle of the view: for the keyboard. Says why it cannot be, or null. */
  pressAtCentre(): string | null {
    if (!this.context.isDrawnOn()) return "This view is to look at. Press in one that shows the draft.";
    const hit = this.view.centreHit();
    if (hit === null) return "There is no surface at the middle of the view.";
    this.strokeStart(hit);
    this.strokeEnd();
    return null;
  }

  private get isStroking(): boolean {
    return this.drag !== null || this.taken !== null;
  }

  private get settings(): ToolSettings {
    return this.context.shelf.settings.get();
  }

  private colour(): string {
    return this.context.colourOf(this.settings.part);
  }

  /** Settings are those of the moment: keys may change them while the drag goes on. */
  private startPaint(open: OpenShape, hit: Hit): void {
    const { part, onlyOver } = this.settings;
    const brush = this.brush();
    const faces = new Drag(open.model.mesh, brush, this.opened(open));
    this.drag = { faces, stroke: { kind: "paint", ...brush, label: part, only_over: onlyOver } };
    open.model.setPreview(faces.click(hit.face), this.colour());
  }

  private brush(): Brush {
    const { radius, hasAngleLimit, angleDegrees } = this.settings;
    return { radius, min_cosine: hasAngleLimit ? cosineOfLimit(angleDegrees) : null };
  }

  /** Which faces may be painted; all where it is left out. */
  private opened({ labels }: OpenShape): ((face: number) => boolean) | undefined {
    const { onlyOver } = this.settings;
    return onlyOver === null ? undefined : (face) => labels[face] === onlyOver;
  }

  private takePatches(open: OpenShape, hits: readonly Hit[]): void {
    const patches = this.context.patches();
    if (patches === null) return;
    const isFirst = this.taken === null;
    this.taken ??= new Set();
    for (const { face } of hits) {
      if (this.taken.has(face)) continue;
      const faces = patches.around(face);
      for (const each of faces) this.taken.add(each);
      if (!isFirst) open.model.addPreview(faces);
      else open.model.setPreview(faces, this.colour());
    }
  }

  private hovered(open: OpenShape, hit: Hit | null): Uint32Array | null {
    if (hit === null || !open.canEdit) return null;
    const { tool } = this.settings;
    if (tool === "paint") return clickedFaces(open.model.mesh, hit.face, this.brush(), this.opened(open));
    if (tool === "patches") return this.context.patches()?.around(hit.face) ?? null;
    if (tool !== "segment") return null;
    const version = open.version.get();
    const isKnown = this.region?.version === version && this.region.faces.includes(hit.face);
    if (!isKnown) {
      this.region = { version, faces: regionOf(open.model.mesh.graph, open.labels, hit.face) };
    }
    return this.region?.faces ?? null;
  }

  private done(open: OpenShape, operation: Operation): void {
    this.region = null;
    open.model.setPreview(null);
    open.perform(operation);
  }
}
