/** Shapes in a person's hands, which of them is worked on, and the next one loaded ahead. */
import { Problem } from "../../../api/problem";
import type { ConfirmOutcome } from "../../../drafts/confirming";
import type { Lease, LeaseApi, RefusedClaim } from "../../../drafts/leaseApi";
import type { Renewed } from "../../../drafts/leaseKeeper";
import { Observable } from "../../../drafts/observable";
import type { DraftIdentity } from "../../../drafts/outbox";
import type { HeldShape, Opening } from "./heldShape";

/** As many as the service lets one person hold. */
export const MAX_HELD = 4;

export interface DeskParts {
  readonly leases: LeaseApi;
  /** isNamed : asked for by name, rather than handed out by the queue. */
  hold(leased: Renewed<Lease>, isNamed: boolean): HeldShape;
}

export interface DeskState {
  readonly phase: "opening" | "working" | "empty" | "failed";
  readonly shapes: readonly HeldShape[];
  readonly current: HeldShape | null;
  /** Why there is nothing to show. */
  readonly why: string | null;
  /** Shapes that were asked for and are not to be had. */
  readonly refused: readonly RefusedClaim[];
}

const AT_FIRST: DeskState = { phase: "opening", shapes: [], current: null, why: null, refused: [] };

export class Desk {
  readonly state = new Observable<DeskState>(AT_FIRST);
  /** A shape is off the desk, and its draft closed: strokes of it that were not sent are nobody's. */
  onLeft: () => void = () => {};
  private ahead: HeldShape | null = null;
  private isClosed = false;
  /** Shapes by name that are still to be had: none any more once one is in hand. */
  private askedFor: readonly number[] = [];

  /** opening : asked each time, since parts and preferences change. */
  constructor(
    private readonly parts: DeskParts,
    private readonly collectionId: number,
    private readonly opening: () => Opening,
  ) {}

  /** Takes up what is held already; shapes by name, or else the next of the queue. */
  async start(named: readonly number[]): Promise<void> {
    this.askedFor = named;
    this.change({ phase: "opening" });
    await Promise.resolve(); // who leaves at once, as a page that is mounted twice, claims nothing
    if (this.isClosed) return;
    const since = performance.now();
    await this.attempt(async () => {
      const refused: RefusedClaim[] = [];
      if (named.length > 0) refused.push(...(await this.claimNamed(named)));
      this.change({ refused });
      for (const leased of await this.parts.leases.held(this.collectionId)) this.takeHeld(leased, since);
      const wanted = this.state.get().shapes.find((shape) => shape.shapeId === named[0]);
      const first = wanted ?? this.state.get().shapes[0];
      if (first !== undefined) this.show(first);
      else if (refused.length === 0) await this.claimNext();
      else this.change({ phase: "failed", why: refused.map((each) => each.why).join(" ") });
      void this.loadAhead();
    });
  }

  /** After `start` failed: asks for the same. */
  startAgain(): Promise<void> {
    return this.start(this.askedFor);
  }

  /** Another shape beside those in hand, or the first. */
  async takeNext(): Promise<void> {
    await this.attempt(async () => {
      await this.claimNext();
      void this.loadAhead();
    });
  }

  /** A shape by its name, beside those in hand. */
  async takeNamed(shapeId: number): Promise<void> {
    const inHand = this.state.get().shapes.find((shape) => shape.shapeId === shapeId);
    if (inHand !== undefined) this.show(inHand);
    else if (this.ahead?.shapeId === shapeId) await this.takeNext();
    else await this.attempt(() => this.claimAndShow(shapeId));
  }

  show(shape: HeldShape): void {
    this.askedFor = [];
    this.change({ phase: "working", current: shape, why: null });
    this.begin(shape);
  }

  /** Has a shape in hand ready to be worked on, whether or not it is the one that is worked on. */
  begin(shape: HeldShape): void {
    if (shape.state.get().step !== "failed") void shape.begin(this.opening());
  }

  /** Confirms the labels in hand; what comes next is shown at once if that is done. */
  async confirm(shape: HeldShape): Promise<ConfirmOutcome> {
    if (shape.open === null) return { kind: "unsaved" };
    const outcome = await shape.open.confirm();
    if (outcome.kind === "confirmed") await this.leave(shape);
    return outcome;
  }

  async skip(shape: HeldShape, reason: string): Promise<void> {
    await this.parts.leases.skip(shape.lease.id, reason);
    await this.leave(shape);
  }

  /** Gives a shape back to the queue; the draft stays. */
  async release(shape: HeldShape): Promise<void> {
    await this.attempt(async () => {
      await this.parts.leases.release(shape.lease.id);
      await this.leave(shape);
    });
  }

  /** Takes a shape off the desk that is not this tab's any more, and goes on. */
  async leave(shape: HeldShape): Promise<void> {
    shape.keeper.stop(); // a renewal would find its lease ended, and claim it again
    const shapes = this.state.get().shapes.filter((each) => each !== shape);
    const wasCurrent = this.state.get().current === shape;
    this.change({ shapes });
    if (wasCurrent) {
      const [other] = shapes;
      if (other !== undefined) this.show(other);
      else await this.takeNext();
    }
    await shape.close();
    this.onLeft();
  }

  /** Whether a draft is open here, or may be once its shape is. */
  isAtWork(draft: DraftIdentity): boolean {
    if (this.state.get().phase === "opening") return true;
    const shape = this.all().find((each) => each.shapeId === draft.shapeId);
    return shape !== undefined && (shape.open === null || shape.open.draft.sender.draft.key === draft.key);
  }

  dismissRefusals(): void {
    this.change({ refused: [] });
  }

  /** Something may work again. */
  wake(): void {
    for (const shape of this.all()) {
      shape.open?.draft.wake();
      if (shape.open === null) void shape.keeper.renew();
    }
  }

  /** A lease of this person's ended elsewhere, or began: looks what has become of it. */
  async recheck(shapeId: number): Promise<void> {
    const shape = this.all().find((each) => each.shapeId === shapeId);
    await shape?.keeper.renew();
    const isGone = shape?.keeper.state.get().kind === "ended" && shape === this.ahead;
    if (!isGone) return;
    this.ahead = null; // nobody has seen it yet: another one comes in its place, and no word about it
    await shape.close();
    await this.loadAhead();
  }

  async close(): Promise<void> {
    this.isClosed = true;
    await Promise.all(this.all().map((shape) => shape.close()));
  }

  private all(): HeldShape[] {
    return [...this.state.get().shapes, ...(this.ahead === null ? [] : [this.ahead])];
  }

  private async claimNamed(named: readonly number[]): Promise<readonly RefusedClaim[]> {
    const since = performance.now();
    try {
      const { leases, refused } = await this.parts.leases.named(this.collectionId, named.slice(0, MAX_HELD));
      for (const leased of leases) this.take(leased, true, since);
      return refused;
    } catch (error) {
      if (!(error instanceof Problem) || error.status !== 409) throw error;
      return [{ shape_id: named[0] as number, why: error.message }]; // none of them, and why
    }
  }

  private async claimAndShow(shapeId: number): Promise<void> {
    this.change({ refused: await this.claimNamed([shapeId]) });
    const taken = this.state.get().shapes.find((shape) => shape.shapeId === shapeId);
    if (taken !== undefined) this.show(taken);
  }

  private takeHeld(leased: Renewed<Lease>, since: number): void {
    if (this.all().some((shape) => shape.shapeId === leased.lease.shape_id)) return;
    if (leased.lease.is_prefetched) this.ahead = this.parts.hold(leased, false);
    else this.take(leased, false, since);
  }

  private async claimNext(): Promise<void> {
    const since = performance.now();
    const ahead = this.ahead;
    this.ahead = null;
    if (ahead !== null) {
      this.change({ shapes: [...this.state.get().shapes, ahead] });
      this.show(ahead);
      await ahead.takenUp();
      return;
    }
    const leased = await this.parts.leases.next(this.collectionId, false);
    if (leased !== null) this.show(this.take(leased, false, since));
    else if (this.state.get().shapes.length === 0) this.change({ phase: "empty", current: null });
  }

  /** Once the shape in hand is to be seen: the next one must not hold it up. */
  private async loadAhead(): Promise<void> {
    if (this.isClosed || this.state.get().phase !== "working") return;
    if (this.ahead === null) {
      const leased = await this.parts.leases.next(this.collectionId, true).catch(() => null); // claimed when needed, then
      if (leased === null || this.all().some((shape) => shape.shapeId === leased.lease.shape_id)) return;
      this.ahead = this.parts.hold(leased, false);
    }
    const { ahead } = this;
    if (this.isClosed) return await ahead.close();
    await this.state.get().current?.seen();
    if (!this.isClosed) ahead.load(this.opening(), performance.now());
  }

  private take(leased: Renewed<Lease>, isNamed: boolean, since: number): HeldShape {
    const shape = this.loaded(leased, isNamed, since);
    this.change({ shapes: [...this.state.get().shapes, shape] });
    return shape;
  }

  private loaded(leased: Renewed<Lease>, isNamed: boolean, since: number): HeldShape {
    const shape = this.parts.hold(leased, isNamed);
    if (this.isClosed) void shape.close();
    else shape.load(this.opening(), since);
    return shape;
  }

  private async attempt(work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      const why = error instanceof Error ? error.message : String(error);
      const { phase, shapes } = this.state.get();
      const [first] = shapes;
      if (first === undefined) this.change({ phase: "failed", current: null, why });
      else if (phase === "opening") this.show(first);
      else this.change({ why });
    }
  }

  private change(some: Partial<DeskState>): void {
    if (!this.isClosed) this.state.set({ ...this.state.get(), ...some });
  }
}
