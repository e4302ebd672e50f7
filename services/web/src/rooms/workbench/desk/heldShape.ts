/** A leased shape on its way onto the screen: the mesh first, so that it can be seen, then labels and strokes. */
import { Problem } from "../../../api/problem";
import { DraftSession, type SessionParts } from "../../../drafts/draftSession";
import { type Lease, leaseApi } from "../../../drafts/leaseApi";
import { LeaseKeeper, type Renewed } from "../../../drafts/leaseKeeper";
import { Observable } from "../../../drafts/observable";
import { type ComingMesh, type MeshWish, readMesh } from "../../../viewer/meshReader";
import { onScreen } from "../../../viewer/onScreen";
import { meshOf } from "../../../viewer/preparedMesh";
import { readTree } from "../../../viewer/searchTree";
import { ShapeModel } from "../../../viewer/shapeModel";
import type { PreparedSurface } from "../../../viewer/surfacePreparation";
import { type Draft, OpenShape } from "../shape/openShape";
import {
  fetchDraftBase,
  fetchFacts,
  fetchLabels,
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
  /** Null while they are not known. */
  readonly partIds: readonly number[] | null;
  readonly start: StartChoice;
}

interface StartLabels {
  readonly from: Segmentation;
  readonly labels: Uint16Array;
}

interface Loading {
  readonly model: Promise<ShapeModel>;
  /** Ends once faces of the model are found under a pointer. */
  readonly pickable: Promise<void>;
  readonly facts: Promise<ShapeFacts>;
  readonly start: Promise<StartLabels | null>;
}

interface Drafted {
  readonly draft: Draft;
  readonly base: Uint16Array | null;
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
  /** Why the shape begins without the labels that it should start from; null if it does not. */
  readonly startTrouble = new Observable<string | null>(null);
  readonly keeper: LeaseKeeper<Lease>;
  private loading: Loading | null = null;
  private drafting: Promise<Drafted> | null = null;
  private takingUp: Promise<void> | null = null;
  private hasBegun = false;
  private isClosed = false;

  /** isNamed : asked for by name, to go on with its labels, rather than handed out by the queue. */
  constructor(
    private readonly parts: SessionParts,
    leased: Renewed<Lease>,
    private readonly isNamed: boolean,
    private readonly read: (wish: MeshWish) => ComingMesh = readMesh,
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
  load(opening: Opening, since: number): Loading {
    if (this.loading !== null) return this.loading;
    const loading = {
      ...this.surface(since),
      facts: this.known(),
      start: this.startLabels(opening.start),
    };
    this.loading = loading;
    const isFresh = this.lease.is_prefetched; // nobody has drawn on it yet, most likely
    Promise.all(Object.values(loading)).catch(() => {
      this.loading = null; // `begin` says so; trying again fetches again
    });
    if (isFresh) void this.showStart(loading).catch(() => {}); // `begin` says why
    return loading;
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
    const loading = this.load(opening, performance.now());
    try {
      await this.takenUp();
      if (this.isClosed) return;
      this.drafting ??= this.draftedOnce(loading.facts);
      const [model, { draft, base }, start] = await Promise.all([
        loading.model,
        this.drafting,
        loading.start,
        loading.pickable,
      ]);
      const open = await OpenShape.open(model, draft, base, opening.partIds);
      if (this.isClosed) return await open.close();
      if (draft.strokes.length === 0 && base === null && start !== null) await this.startFrom(open, start);
      if (this.isClosed) return await open.close();
      this.state.set({ step: "ready", model, open });
    } catch (error) {
      this.hasBegun = false;
      const before = this.state.get();
      this.state.set({ step: "failed", why: error instanceof Error ? error.message : String(error) });
      if (before.step === "labels") before.model.dispose(); // trying again has it drawn anew, or another one
    }
  }

  /** Ends once the shape shows with its labels, or will not. */
  seen(): Promise<void> {
    return new Promise((resolve) => {
      const stop = this.state.subscribe(check);
      const state = this.state;
      function check() {
        const { step } = state.get();
        if (step === "mesh" || step === "labels") return;
        stop();
        resolve();
      }
      check();
    });
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
    else {
      if (state.step === "labels") state.model.dispose();
      await this.drafting?.then(({ draft }) => draft.close()).catch(() => {}); // it was not opened after all
    }
  }

  private surface(since: number): Pick<Loading, "model" | "pickable"> {
    const coming = this.coming();
    const model = coming.then(({ surface }) => surface).then((surface) => this.shown(surface, since));
    const pickable = model.then(async (shown) => {
      await onScreen(shown.drawn); // finding faces can wait, seeing the shape cannot
      const { tree } = await coming;
      shown.pickWith(readTree(await tree(), shown.mesh));
    });
    return { model, pickable };
  }

  private async coming(): Promise<ComingMesh> {
    const { mesh_hash: meshHash, shape_id: shapeId } = this.lease;
    if (meshHash === null)
      throw new Error("This shape has no surface to label yet. Skip it, or tell the operator.");
    return this.read({ meshHash, shapeId });
  }

  private shown(surface: PreparedSurface, since: number): ShapeModel {
    const model = new ShapeModel(meshOf(surface, this.lease.mesh_hash as string), { since });
    if (this.state.get().step === "failed")
      model.dispose(); // labels were refused meanwhile; trying again fetches both
    else if (!this.isClosed) this.state.set({ step: "labels", model });
    return model;
  }

  private async known(): Promise<ShapeFacts> {
    const [facts, note] = await Promise.all([fetchFacts(this.shapeId), fetchReworkNote(this.shapeId)]);
    this.facts.set(facts);
    this.reworkNote.set(note);
    return facts;
  }

  /** While the draft is on its way: what it will most likely start from. */
  private async showStart({ model, start, facts }: Loading): Promise<void> {
    const [shown, labels] = await Promise.all([model, start, facts]);
    const isShown = this.state.get().step === "labels";
    if (isShown && labels?.labels.length === shown.mesh.nFaces && !this.goesOn)
      shown.setLabels(labels.labels);
  }

  /** Labels that do not fit keep nobody from the shape. */
  private async startFrom(open: OpenShape, { from, labels }: StartLabels): Promise<void> {
    try {
      await open.startFrom(from, labels);
    } catch (error) {
      this.startTrouble.set(error instanceof Error ? error.message : String(error));
    }
  }

  /** Whether work goes on from labels that are on record. */
  private get goesOn(): boolean {
    return this.isNamed || this.reworkNote.get() !== null;
  }

  /** Forgotten where it fails, so that trying again opens a draft anew. */
  private draftedOnce(facts: Promise<ShapeFacts>): Promise<Drafted> {
    const drafting = facts.then((known) => this.drafted(known));
    drafting.catch(() => {
      this.drafting = null;
    });
    return drafting;
  }

  private async drafted(facts: ShapeFacts): Promise<Drafted> {
    let draft: Draft | null = null;
    try {
      draft = await DraftSession.open(this.parts, this.keeper, this.goesOn ? facts.headRevision : null);
      const { id, base_revision } = draft.draft;
      return { draft, base: base_revision === null ? null : await fetchDraftBase(id) };
    } catch (error) {
      await draft?.close(); // else it would keep the right to edit from whoever tries again
      throw error;
    }
  }

  private async startLabels(choice: StartChoice): Promise<StartLabels | null> {
    if (this.lease.model_version === null) return null; // no model has seen it
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
