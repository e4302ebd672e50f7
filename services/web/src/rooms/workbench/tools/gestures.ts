/** What a press, a drag and hovering on the surface mean with the tool in hand. */
import { type Brush, clickedFaces, cosineOfLimit, Drag } from "../../../geometry/paint";
import { regionOf } from "../../../geometry/region";
import { runsOf } from "../../../labels/faceRuns";
import type { Operation } from "../../../labels/operations";
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

/** A drag on the surface of one shape, with the settings of the moment it began: keys may change them while it goes on. */
interface SurfaceDrag {
  readonly open: OpenShape;
  /** Faces that a further hit adds to it, ascending. */
  take(face: number): Uint32Array;
  /** Does what it comes to: only now, since a second finger may yet make a pinch of it. */
  finish(): void;
}

const SPACING = 0.25;
const NO_FACES = new Uint32Array(0);

export class ToolGestures implements ViewListener {
  private drag: SurfaceDrag | null = null;
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
    if (this.pointer !== null && this.pointer.on !== model) this.leave(this.pointer.on);
    if (tool !== "paint" || this.view.tool === "navigate") model?.setBrush(null);
    if (this.drag !== null) return;
    model?.setPreview(null);
    if (this.pointer !== null) this.hover(this.pointer.hit);
  }

  hover(hit: Hit | null): void {
    const open = this.context.open();
    if (open === null) return;
    this.pointer = hit === null ? null : { hit, on: open.model };
    const { tool, radius } = this.settings;
    if (tool === "paint") open.model.setBrush(hit === null ? null : { point: hit.point, radius });
    if (this.drag === null) open.model.setPreview(this.hovered(open, hit), this.colour());
  }

  strokeStart(hit: Hit): void {
    this.context.onEngage();
    const open = this.context.open();
    if (open === null || !open.canEdit) return;
    const { tool } = this.settings;
    if (tool === "paint") this.begin(this.painting(open), hit);
    else if (tool === "patches") this.begin(this.takingPatches(open), hit);
    else if (tool === "segment") this.begin(this.takingRegion(open, hit.face), hit);
    else if (tool === "pick") this.begin(this.pickingPart(open, hit.face), hit);
  }

  strokeMove(hits: readonly Hit[]): void {
    const drag = this.goingOn();
    if (drag !== null) for (const { face } of hits) drag.open.model.addPreview(drag.take(face));
  }

  strokeEnd(): void {
    const drag = this.goingOn();
    this.drag = null;
    drag?.finish();
  }

  strokeCancel(): void {
    this.drag?.open.model.setPreview(null);
    this.drag = null;
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

  private get settings(): ToolSettings {
    return this.context.shelf.settings.get();
  }

  private colour(): string {
    return this.context.colourOf(this.settings.part);
  }

  private begin(drag: SurfaceDrag | null, hit: Hit): void {
    this.drag = drag;
    drag?.open.model.setPreview(drag.take(hit.face), this.colour());
  }

  /** The drag in hand; it ends with the shape that it began on, and with the right to change that. */
  private goingOn(): SurfaceDrag | null {
    const open = this.drag?.open;
    if (open !== this.context.open() || !open?.canEdit) this.strokeCancel();
    return this.drag;
  }

  private painting(open: OpenShape): SurfaceDrag {
    const { part, onlyOver } = this.settings;
    const brush = this.brush();
    const faces = new Drag(open.model.mesh, brush, this.opened(open));
    return {
      open,
      take: (face) => faces.click(face),
      finish: () =>
        this.done(open, { kind: "paint", ...brush, label: part, only_over: onlyOver, seeds: faces.seeds }),
    };
  }

  private takingPatches(open: OpenShape): SurfaceDrag | null {
    const patches = this.context.patches();
    if (patches === null) return null;
    const { part } = this.settings;
    const taken = new Set<number>();
    const take = (face: number) => {
      if (taken.has(face)) return NO_FACES;
      const faces = patches.around(face);
      for (const each of faces) taken.add(each);
      return faces;
    };
    const finish = () => this.done(open, { kind: "assign", runs: runsOf(taken), label: part });
    return { open, take, finish };
  }

  private takingRegion(open: OpenShape, seed: number): SurfaceDrag {
    const { part } = this.settings;
    return {
      open,
      take: (face) => (face === seed ? this.regionAt(open, seed) : NO_FACES),
      finish: () => this.done(open, { kind: "segment_wide", seed, label: part }),
    };
  }

  private pickingPart(open: OpenShape, face: number): SurfaceDrag {
    const finish = () => {
      open.model.setPreview(null);
      this.context.shelf.change({ part: open.labels[face] as number, tool: "paint" });
    };
    return { open, take: () => NO_FACES, finish };
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

  private hovered(open: OpenShape, hit: Hit | null): Uint32Array | null {
    if (hit === null || !open.canEdit) return null;
    const { tool } = this.settings;
    if (tool === "paint") return clickedFaces(open.model.mesh, hit.face, this.brush(), this.opened(open));
    if (tool === "patches") return this.context.patches()?.around(hit.face) ?? null;
    return tool === "segment" ? this.regionAt(open, hit.face) : null;
  }

  private regionAt(open: OpenShape, face: number): Uint32Array {
    const version = open.version.get();
    if (this.region?.version === version && this.region.faces.includes(face)) return this.region.faces;
    const faces = regionOf(open.model.mesh.graph, open.labels, face);
    this.region = { version, faces };
    return faces;
  }

  /** The pointer was on a shape that is no longer in the view. */
  private leave(model: ShapeModel): void {
    this.pointer = null;
    model.setBrush(null);
    model.setPreview(null);
  }

  private done(open: OpenShape, operation: Operation): void {
    this.region = null;
    open.model.setPreview(null);
    open.perform(operation);
  }
}
