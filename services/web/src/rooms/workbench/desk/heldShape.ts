/** A leased shape on its way onto the screen: the mesh first, so that it can be seen, then labels and strokes. */
import { Problem } from "../../../api/problem";
import { DraftSession, type SessionParts } from "../../../drafts/draftSession";
import { type Lease, leaseApi } from "../../../drafts/leaseApi";
import { LeaseKeeper, type Renewed } from "../../../drafts/leaseKeeper";
import { Observable } from "../../../drafts/observable";
import { prepareMesh } from "../../../viewer/prepareMesh";
import { ShapeModel } from "../../../viewer/shapeModel";
import { OpenShape } from "../shape/openShape";
import {
  fetchDraftBase,
  fetchFacts,
  fetchLabels,
  fetchMesh,
  fetchReworkNote,
  type Segmentation,
  type ShapeFacts,
} from "../shape/shapeRequests";
import type { StartChoice } from "../tools/toolSettings";

export type HeldState =
  | { readonly step: "mesh" }
  | { readonly step: "labels"; readonly model: ShapeModel }
  | { readonly step: "ready"; readonly model: ShapeModel; readonly open: OpenShape }
  | { readonly step: "failed"; readonly why: string };

export interface Opening {
  readonly partIds: readonly number[];
  readonly start: StartChoice;
}

interface StartLabels {
  readonly from: Segmentation;
  readonly labels: Uint16Array;
}

const STARTS: Readonly<Record<StartChoice, readonly Segmentation[]>> = {
  best: ["refined", "predicted"],
  refined: ["refined"],
  predicted: ["predicted"],
  nothing: [],
};

export class HeldShape {
  readonly state = new Observable<HeldState>({ step: "mesh" });
  readonly facts = new Observable<ShapeFacts | null>(null);
  /** What a reviewer wrote when they sent the labels back; null if they did not. */
  readonly reworkNote = new Observable<string | null>(null);
  readonly keeper: LeaseKeeper<Lease>;
  private loading: Promise<[ShapeModel, ShapeFacts, StartLabels | null]> | null = null;
  private takingUp: Promise<void> | null = null;
  private hasBegun = false;
  private isClosed = false;

  /** isNamed : asked for by name, to go on with its labels, rather than handed out by the queue. */
  constructor(
    private readonly parts: SessionParts,
    leased: Renewed<Lease>,
    private readonly isNamed: boolean,
  ) {
    this.keeper = new LeaseKeeper(leaseApi, parts.clock, leased);
  }

  get lease(): Lease {
    return this.keeper.lease;
  }

  get shapeId(): number {
    return this.lease.shape_id;
  }

  get open(): OpenShape | null {
    const state = this.state.get();
    return state.step === "ready" ? state.open : null;
  }

  /** Fetches what can be had before work begins: mesh, facts, labels to start from. */
  load(opening: Opening, since: number): void {
    this.loading ??= Promise.all([this.shown(since), this.known(), this.startLabels(opening.start)]);
    this.loading.catch(() => {
      this.loading = null; // `begin` says so; trying again fetches again
    });
  }

  /** Ends once the service knows that the shape is worked on, where it was loaded ahead: it hands it out again else. */
  takenUp(): Promise<void> {
    this.takingUp ??= this.lease.is_prefetched ? this.keeper.renew(false) : Promise.resolve();
    return this.takingUp;
  }

  /** Work begins: opens the draft, where it was left. */
  async begin(opening: Opening): Promise<void> {
    if (this.isClosed || this.hasBegun) return;
    this.hasBegun = true;
    this.load(opening, performance.now());
    try {
      await this.takenUp();
      const [model, facts, start] = await (this.loading as NonNullable<typeof this.loading>);
      const open = await this.opened(model, facts, opening);
      if (this.isClosed) return await open.close();
      if (open.draft.strokes.length === 0 && open.draft.draft.base_revision === null && start !== null) {
        await open.replaceLabels("start_from", { from: start.from }, start.labels);
      }
      this.state.set({ step: "ready", model, open });
    } catch (error) {
      this.hasBegun = false;
      this.state.set({ step: "failed", why: error instanceof Error ? error.message : String(error) });
    }
  }

  /** After `begin` failed. */
  retry(opening: Opening): Promise<void> {
    this.state.set({ step: "mesh" });
    return this.begin(opening);
  }

  async close(): Promise<void> {
    this.isClosed = true;
    this.keeper.stop();
    const state = this.state.get();
    if (state.step === "ready") await state.open.close();
    else if (state.step === "labels") state.model.dispose();
  }

  private async shown(since: number): Promise<ShapeModel> {
    const { mesh_hash, shape_id } = this.lease;
    if (mesh_hash === null)
      throw new Error("This shape has no surface to label yet. Skip it, or tell the operator.");
    const model = new ShapeModel(await prepareMesh(await fetchMesh(mesh_hash, shape_id)), { since });
    if (!this.isClosed) this.state.set({ step: "labels", model });
    return model;
  }

  private async known(): Promise<ShapeFacts> {
    const [facts, note] = await Promise.all([fetchFacts(this.shapeId), fetchReworkNote(this.shapeId)]);
    this.facts.set(facts);
    this.reworkNote.set(note);
    return facts;
  }

  private async opened(model: ShapeModel, facts: ShapeFacts, opening: Opening): Promise<OpenShape> {
    const goesOn = this.isNamed || this.reworkNote.get() !== null;
    const wanted = goesOn ? facts.headRevision : null;
    const draft = await DraftSession.open(this.parts, this.keeper, wanted);
    const base = draft.draft.base_revision === null ? null : await fetchDraftBase(draft.draft.id);
    return OpenShape.open(model, draft, base, opening.partIds);
  }

  private async startLabels(choice: StartChoice): Promise<StartLabels | null> {
    for (const from of STARTS[choice]) {
      try {
        return { from, labels: await fetchLabels(this.shapeId, from) };
      } catch (error) {
        if (!(error instanceof Problem && error.status === 404)) throw error;
      }
    }
    return null;
  }
}
