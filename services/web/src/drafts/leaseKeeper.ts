/** Holds a leased shape for its person by renewing the lease, and notices when it was lost. */

import { Problem } from "../api/problem";
import { Backoff } from "./backoff";
import type { Clock } from "./clock";
import { Observable } from "./observable";
import { failureOf } from "./transport";

export interface LeaseRecord {
  readonly id: number;
  readonly shape_id: number;
  readonly collection_id: number;
  readonly acquired_at: string;
  readonly expires_at: string;
}

export interface Renewed<L extends LeaseRecord> {
  readonly lease: L;
  /** Of the service, milliseconds since 1970: clocks differ. */
  readonly at: number;
}

export interface LeaseTransport<L extends LeaseRecord> {
  renew(leaseId: number, isPrefetched: boolean | null): Promise<Renewed<L>>;
  /** Claims a shape by name again, after its lease was lost. */
  reclaim(collectionId: number, shapeId: number): Promise<Renewed<L>>;
}

export type LeaseState =
  | { readonly kind: "held" }
  /** The service was not reached for longer than the lease lasts: somebody else may have the shape. */
  | { readonly kind: "unsure" }
  /** Somebody else has the shape. Strokes are still taken. */
  | { readonly kind: "lost"; readonly why: string }
  /** Somebody ended the lease: the shape is claimed again only if the person asks. Strokes are still taken. */
  | { readonly kind: "ended"; readonly how: LeaseEnd };

/** taken-away : by an operator. given-back, confirmed : by the person, in another tab or on another computer. */
export type LeaseEnd = "taken-away" | "given-back" | "confirmed";

const SHORTEST_MS = 5_000;
const RENEWALS_A_LEASE = 3;

export class LeaseKeeper<L extends LeaseRecord> {
  readonly state = new Observable<LeaseState>({ kind: "held" });
  /** The shape was claimed anew: its draft must be opened with this lease. */
  onReclaimed: (lease: L) => void = () => {};

  private readonly backoff: Backoff;
  private held: L;
  private expiresAt: number;
  private cancel: (() => void) | null = null;
  private isStopped = false;
  private asking: Promise<void> | null = null;
  /** What is to be told with the next renewal that gets through. */
  private wish: boolean | null = null;

  constructor(
    private readonly transport: LeaseTransport<L>,
    private readonly clock: Clock,
    claimed: Renewed<L>,
  ) {
    this.backoff = new Backoff(clock);
    this.held = claimed.lease;
    this.expiresAt = 0;
    this.hold(claimed);
  }

  get lease(): L {
    return this.held;
  }

  /** Renews now: after sleep, or when the network is back. Ends once the service was told, or was not reached. */
  async renew(isPrefetched: boolean | null = null): Promise<void> {
    this.wish = isPrefetched ?? this.wish;
    if (this.isStopped) return;
    this.asking ??= this.askUntilTold().finally(() => {
      this.asking = null;
    });
    await this.asking;
  }

  /** After it was ended: claims the shape again, because the person wants it. Rejects if it is not to be had. */
  claimBack(): Promise<void> {
    return this.reclaim();
  }

  stop(): void {
    this.isStopped = true;
    this.cancel?.();
    this.backoff.stop();
  }

  /** Once more where another wish came up while the service answered. */
  private async askUntilTold(): Promise<void> {
    let told: boolean | null;
    do {
      this.cancel?.();
      this.backoff.stop();
      told = this.wish;
      await this.ask(told);
    } while (this.isHeld && this.wish !== null && this.wish !== told);
  }

  private get isHeld(): boolean {
    return !this.isStopped && this.state.get().kind === "held";
  }

  private async ask(wish: boolean | null): Promise<void> {
    try {
      this.hold(await this.transport.renew(this.held.id, wish));
      if (this.wish === wish) this.wish = null;
    } catch (error) {
      const failure = failureOf(error);
      const how = endOf(error);
      if (how !== null) this.state.set({ kind: "ended", how });
      else if (failure.kind === "closed" || failure.kind === "stale") await this.claimAgain();
      else this.later(failure.why, failure.kind === "refused");
    }
  }

  private async claimAgain(): Promise<void> {
    try {
      await this.reclaim();
    } catch (error) {
      const failure = failureOf(error);
      this.later(failure.why, failure.kind !== "passing" && failure.kind !== "signed-out");
    }
  }

  private async reclaim(): Promise<void> {
    const renewed = await this.transport.reclaim(this.held.collection_id, this.held.shape_id);
    if (this.isStopped) return;
    this.hold(renewed);
    this.wish = null; // who claims by name works on it
    this.onReclaimed(renewed.lease);
  }

  private hold({ lease, at }: Renewed<L>): void {
    if (this.isStopped) return;
    const lastsMs = Date.parse(lease.expires_at) - at;
    this.held = lease;
    this.expiresAt = this.clock.now() + lastsMs;
    this.backoff.reset();
    this.state.set({ kind: "held" });
    const nextMs = Math.max(SHORTEST_MS, lastsMs / RENEWALS_A_LEASE);
    this.cancel?.();
    this.cancel = this.clock.after(nextMs, () => void this.renew());
  }

  /** Tries again after a while; what was lost may come free. */
  private later(why: string, isLost: boolean): void {
    if (this.isStopped) return;
    if (isLost) this.state.set({ kind: "lost", why });
    else if (this.clock.now() >= this.expiresAt && this.state.get().kind === "held") {
      this.state.set({ kind: "unsure" });
    }
    this.backoff.wait(() => void this.renew());
  }
}

const ENDS: Readonly<Record<string, LeaseEnd>> = {
  cleared: "taken-away",
  released: "given-back",
  skipped: "given-back",
  completed: "confirmed",
};

/** How somebody ended the lease that is not renewed; null if nobody did, but time. */
function endOf(error: unknown): LeaseEnd | null {
  const outcome = error instanceof Problem ? error.document.outcome : undefined;
  return typeof outcome === "string" ? (ENDS[outcome] ?? null) : null;
}
