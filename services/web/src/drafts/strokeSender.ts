/**
 * Brings the strokes of one draft to the service: each first into the outbox, then in order, each once.
 *
 * The log here is what is on record (`nRecorded`) and what follows on it. A stroke may be sent again as often as it
 * takes, since its id says that it is the same. Where the log on record is another than expected, both are compared: if
 * nothing here contradicts it, the log here follows; else the person is asked, and neither side is lost.
 */

import type { StrokeJson } from "../labels/strokes";
import { Backoff } from "./backoff";
import type { Clock } from "./clock";
import { Observable } from "./observable";
import type { AsideReason, DraftIdentity, Outbox } from "./outbox";
import { chained, compare, type Divergence } from "./reconcile";
import type { SaveState } from "./saveState";
import { type DraftTransport, type Failure, failureOf } from "./transport";

const MAX_BATCH_STROKES = 200;
const MAX_BATCH_BYTES = 1_000_000;
const ANSWER_MS = 30_000;

export interface SenderParts {
  readonly transport: DraftTransport;
  readonly outbox: Outbox;
  readonly clock: Clock;
}

export class StrokeSender {
  readonly state = new Observable<SaveState>({ kind: "saved" });
  /** Strokes came that were made elsewhere: what is shown must be made anew from `strokes`. */
  onReplaced: () => void = () => {};

  private readonly backoff: Backoff;
  private readonly storing = new Map<string, Promise<void>>();
  private readonly unkept = new Set<string>();
  private blocked: Exclude<Failure, { kind: "passing" | "stale" }> | null = null;
  private divergence: Divergence | null = null;
  private offline: string | null = null;
  private isRunning = false;
  private isPaused = true;
  private request: AbortController | null = null;
  private log: StrokeJson[] = [];
  private nRecorded = 0;

  constructor(
    private readonly parts: SenderParts,
    readonly draft: DraftIdentity,
  ) {
    this.backoff = new Backoff(parts.clock);
  }

  get outbox(): Outbox {
    return this.parts.outbox;
  }

  /** All strokes, on record or not, in order. */
  get strokes(): readonly StrokeJson[] {
    return this.log;
  }

  /** How many of them the service is known to have. */
  get nOnRecord(): number {
    return this.nRecorded;
  }

  /** Those that the service is not known to have. */
  get pending(): readonly StrokeJson[] {
    return this.log.slice(this.nRecorded);
  }

  /**
   * Takes up the log on record, with what the outbox kept behind it, and what only this tab has. Sends nothing until `resume`.
   *
   * read : the log on record. It is read after the outbox: what another sender brings to the service meanwhile is in one of both.
   * keepsHeard : also strokes that another tab told of, which it may have given up since.
   */
  async adopt(read: () => Promise<readonly StrokeJson[]>, { keepsHeard = false } = {}): Promise<void> {
    const kept = await this.parts.outbox.pending(this.draft.key).catch(() => []);
    const recorded = await read();
    const known = new Set(kept.map((stroke) => stroke.id));
    const own = this.pending.filter(({ id }) => keepsHeard || this.unkept.has(id) || this.storing.has(id));
    const unsent = [...kept, ...own.filter((stroke) => !known.has(stroke.id))];
    const { log, strays } = chained(recorded, unsent);
    await this.setAside(log.slice(0, strays[0]?.sequence), strays, "two-windows");
    this.log = log;
    this.divergence = null;
    await this.settleWith(recorded);
    await this.parts.outbox.remove(this.draft.key, recorded).catch(() => {});
    this.publish();
  }

  /** A stroke that another tab made, and sends. */
  follow(stroke: StrokeJson): boolean {
    const isNext = stroke.sequence === this.log.length;
    if (isNext) this.log.push(stroke);
    return isNext;
  }

  /** Keeps a stroke and sends it. It must follow on the log. */
  append(stroke: StrokeJson): void {
    if (stroke.sequence !== this.log.length) {
      throw new RangeError(
        `the next stroke must have sequence ${this.log.length} but has ${stroke.sequence}`,
      );
    }
    this.log.push(stroke);
    this.keep(stroke);
    this.publish();
    this.resume();
  }

  /** Something may work again: keeps what could not be kept, and sends what waits. */
  wake(): void {
    for (const stroke of this.pending) {
      if (this.unkept.has(stroke.id) && !this.storing.has(stroke.id)) this.keep(stroke);
    }
    this.resume();
  }

  /** Sends what waits, now: at the start, and when there is reason to believe that it works again. */
  resume(): void {
    this.isPaused = false;
    this.backoff.stop();
    if (this.blocked?.kind === "signed-out") this.blocked = null;
    void this.run();
  }

  /** Sends no more. What is not on record stays in the outbox; the promise ends once it is there. */
  async pause(): Promise<void> {
    this.isPaused = true;
    this.backoff.stop();
    this.request?.abort();
    await Promise.all(this.storing.values());
  }

  /** Whether everything is on record, after trying once more. */
  async flush(): Promise<boolean> {
    this.resume();
    while (this.isRunning) await this.changed();
    return this.pending.length === 0 && this.blocked === null && this.divergence === null;
  }

  /** Compares with the log on record, and follows it where nothing here contradicts it. */
  async refresh(): Promise<void> {
    try {
      await this.reconcile();
    } catch (error) {
      this.fail(failureOf(error));
    }
    this.publish();
    void this.run();
  }

  /** Goes on from the strokes on record; those made here are set aside. */
  async takeTheirs(): Promise<void> {
    const { common, mine, theirs } = this.openDivergence();
    const before = this.log.slice(0, common);
    await this.setAside(before, mine, "took-theirs");
    this.settle([...before, ...theirs], common + theirs.length);
  }

  /** Goes on from the strokes on record with `mine` on top, which stand for those made here. */
  async keepMine(mine: readonly StrokeJson[]): Promise<void> {
    const divergence = this.openDivergence();
    const base = [...this.log.slice(0, divergence.common), ...divergence.theirs];
    await this.parts.outbox.replace(this.draft, divergence.mine, mine).catch(() => {
      for (const { id } of mine) this.unkept.add(id);
    });
    this.settle([...base, ...mine], base.length);
  }

  /** Gives up what the service does not take: it is set aside, and the log is what is on record. */
  async withdraw(): Promise<void> {
    const isClosed = this.blocked?.kind === "closed";
    const recorded = this.log.slice(0, this.nRecorded);
    await this.setAside(recorded, this.pending, isClosed ? "closed" : "refused");
    if (!isClosed) this.blocked = null; // no further stroke would be taken either
    this.settle(recorded, recorded.length);
  }

  private keep(stroke: StrokeJson): void {
    const stored = this.parts.outbox.add(this.draft, stroke).then(
      () => void this.unkept.delete(stroke.id),
      () => void this.unkept.add(stroke.id), // no room, or no database at all: it still goes out from memory
    );
    this.storing.set(stroke.id, stored);
    void stored.then(() => {
      this.storing.delete(stroke.id);
      this.publish();
    });
  }

  private async setAside(
    before: readonly StrokeJson[],
    strokes: readonly StrokeJson[],
    reason: AsideReason,
  ): Promise<void> {
    if (strokes.length === 0) return;
    const { clock, outbox } = this.parts;
    await outbox.setAside({ draft: this.draft, before, at: clock.now(), reason, strokes });
  }

  private settle(log: StrokeJson[], nRecorded: number): void {
    this.log = log;
    this.nRecorded = nRecorded;
    this.divergence = null;
    this.publish();
    this.onReplaced();
    void this.run();
  }

  private openDivergence(): Divergence {
    if (this.divergence === null) throw new Error("there is no conflict to settle");
    return { ...this.divergence, mine: this.log.slice(this.divergence.common) };
  }

  private async run(): Promise<void> {
    if (this.isRunning) return;
    this.isRunning = true;
    try {
      while (this.mayRun() && (await this.step()));
    } finally {
      this.isRunning = false;
      this.publish();
    }
  }

  private mayRun(): boolean {
    return !this.isPaused && this.blocked === null && this.divergence === null && this.pending.length > 0;
  }

  /** Sends one batch; whether to go on at once. */
  private async step(): Promise<boolean> {
    const batch = this.nextBatch();
    await Promise.all(batch.map((stroke) => this.storing.get(stroke.id)));
    if (this.isPaused) return false;
    try {
      await this.send(batch);
      return true;
    } catch (error) {
      return await this.handle(failureOf(error));
    }
  }

  private nextBatch(): StrokeJson[] {
    const batch: StrokeJson[] = [];
    let bytes = 0;
    for (const stroke of this.log.slice(this.nRecorded, this.nRecorded + MAX_BATCH_STROKES)) {
      bytes += JSON.stringify(stroke).length;
      if (batch.length > 0 && bytes > MAX_BATCH_BYTES) break;
      batch.push(stroke);
    }
    return batch;
  }

  private async send(batch: readonly StrokeJson[]): Promise<void> {
    const first = this.nRecorded;
    await this.asked((signal) => this.parts.transport.append(this.draft.draftId, first, batch, signal));
    await this.acknowledge(batch, first + batch.length);
    this.offline = null;
    this.backoff.reset();
    this.publish();
  }

  private async acknowledge(strokes: readonly StrokeJson[], nRecorded: number): Promise<void> {
    this.nRecorded = Math.max(this.nRecorded, nRecorded);
    for (const stroke of strokes) this.unkept.delete(stroke.id);
    // left in the outbox they would only be compared with the record once more
    await this.parts.outbox.remove(this.draft.key, strokes).catch(() => {});
  }

  private async handle(failure: Failure): Promise<boolean> {
    if (failure.kind !== "stale") {
      this.fail(failure);
      return false;
    }
    try {
      await this.reconcile();
      return this.divergence === null;
    } catch (error) {
      this.fail(failureOf(error));
      return false;
    }
  }

  private async reconcile(): Promise<void> {
    const recorded = await this.asked((signal) =>
      this.parts.transport.strokes(this.draft.draftId, -1, signal),
    );
    await this.settleWith(recorded);
    this.offline = null;
  }

  private async settleWith(recorded: readonly StrokeJson[]): Promise<void> {
    const found = compare(this.log, recorded);
    if (found.kind === "diverged") {
      this.nRecorded = found.divergence.common;
      this.divergence = found.divergence;
      return;
    }
    const known = this.log.slice(this.nRecorded, found.nRecorded);
    this.nRecorded = found.nRecorded; // less than before, if the service was restored from a backup
    this.log = found.log;
    await this.acknowledge(known, found.nRecorded);
    if (found.isBehind) this.onReplaced();
  }

  private fail(failure: Failure): void {
    if (this.isPaused) return;
    if (failure.kind === "passing" || failure.kind === "stale") {
      this.offline = failure.why;
      this.backoff.wait(() => void this.run());
    } else {
      this.blocked = failure;
    }
    this.publish();
  }

  private async asked<T>(call: (signal: AbortSignal) => Promise<T>): Promise<T> {
    const request = new AbortController();
    this.request = request;
    const giveUp = this.parts.clock.after(ANSWER_MS, () => request.abort());
    try {
      return await call(request.signal);
    } finally {
      giveUp();
      this.request = null;
    }
  }

  private changed(): Promise<void> {
    return new Promise((resolve) => {
      const stop = this.state.subscribe(() => {
        stop();
        resolve();
      });
    });
  }

  private publish(): void {
    this.state.set(this.described());
  }

  private described(): SaveState {
    const nQueued = this.log.length - this.nRecorded;
    const queued = { nQueued, isKept: !this.pending.some(({ id }) => this.unkept.has(id)) };
    if (this.divergence !== null) return { ...queued, kind: "conflict", divergence: this.divergence };
    if (this.blocked !== null) return { ...queued, ...this.blocked };
    if (nQueued === 0) return { kind: "saved" };
    const isStored = this.storing.size === 0; // until then a closed tab would lose a stroke
    if (this.offline !== null && isStored) return { ...queued, kind: "offline", why: this.offline };
    return { ...queued, kind: "saving" };
  }
}
