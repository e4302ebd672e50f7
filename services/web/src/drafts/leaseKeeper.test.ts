import { beforeEach, describe, expect, it } from "vitest";
import { Unreachable } from "../api/problem";
import { LeaseKeeper, type LeaseRecord, type LeaseTransport, type Renewed } from "./leaseKeeper";
import { conflict, HandClock, settled } from "./testing";

const LEASE_MS = 300_000;

let clock: HandClock;
let answers: (() => Renewed<LeaseRecord>)[];
let claims: (() => Renewed<LeaseRecord>)[];
let nRenewals: number;
let told: (boolean | null)[];

beforeEach(() => {
  clock = new HandClock();
  answers = [];
  claims = [];
  nRenewals = 0;
  told = [];
});

/** The service's clock is a day ahead of this one. */
function renewed(id = 1): Renewed<LeaseRecord> {
  const at = clock.now() + 86_400_000;
  const expires_at = new Date(at + LEASE_MS).toISOString();
  return { at, lease: { id, shape_id: 3, collection_id: 1, acquired_at: expires_at, expires_at } };
}

const transport: LeaseTransport<LeaseRecord> = {
  async renew(_id, isPrefetched) {
    nRenewals++;
    told.push(isPrefetched);
    return (answers.shift() ?? renewed)();
  },
  reclaim: async () => (claims.shift() ?? (() => renewed(2)))(),
};

const fails = (error: Error) => () => {
  throw error;
};

describe("a lease", () => {
  it("is renewed three times in its length, whatever the clocks say", async () => {
    const keeper = new LeaseKeeper(transport, clock, renewed());
    await clock.advance(LEASE_MS);
    expect(nRenewals).toBe(3);
    expect(keeper.state.get()).toEqual({ kind: "held" });
  });

  it("is unsure once the service was not reached for its length, and held again after", async () => {
    const keeper = new LeaseKeeper(transport, clock, renewed());
    answers = Array(1000).fill(fails(new Unreachable("cut")));
    await clock.advance(LEASE_MS - 1000);
    expect(keeper.state.get().kind).toBe("held");
    await clock.advance(60_000);
    expect(keeper.state.get().kind).toBe("unsure");
    answers = [];
    await clock.advance(60_000);
    expect(keeper.state.get().kind).toBe("held");
  });

  it("that ended is claimed anew by name, and its draft is to be opened with the new one", async () => {
    const keeper = new LeaseKeeper(transport, clock, renewed());
    const opened: number[] = [];
    keeper.onReclaimed = (lease) => opened.push(lease.id);
    answers = [fails(conflict("lease 1 is expired"))];
    await clock.advance(LEASE_MS / 3);
    expect(opened).toEqual([2]);
    expect(keeper.lease.id).toBe(2);
    expect(keeper.state.get().kind).toBe("held");
  });

  it("that somebody else has is lost, says why, and comes back once it is free", async () => {
    const keeper = new LeaseKeeper(transport, clock, renewed());
    answers = [fails(conflict("lease 1 is expired")), fails(conflict("lease 1 is expired"))];
    claims = [fails(conflict("shape 3 is with Ben"))];
    await clock.advance(LEASE_MS / 3);
    expect(keeper.state.get()).toEqual({ kind: "lost", why: "shape 3 is with Ben" });
    await clock.advance(60_000);
    expect(keeper.state.get().kind).toBe("held");
  });

  it("that an operator took away is left to others, and claimed again only when the person asks", async () => {
    const keeper = new LeaseKeeper(transport, clock, renewed());
    answers = [fails(conflict("lease 1 is cleared", { outcome: "cleared" }))];
    await keeper.renew();
    await clock.advance(10 * LEASE_MS);
    expect([keeper.state.get(), nRenewals, keeper.lease.id]).toEqual([
      { kind: "ended", how: "taken-away" },
      1,
      1,
    ]);

    claims = [fails(conflict("chair.off is with someone else now"))];
    await expect(keeper.claimBack()).rejects.toThrow("with someone else");
    expect(keeper.state.get().kind).toBe("ended");
    await keeper.claimBack();
    expect([keeper.state.get().kind, keeper.lease.id]).toEqual(["held", 2]);
  });

  it.each([
    ["skipped", "given-back"],
    ["released", "given-back"],
    ["completed", "confirmed"],
  ])("that its person ended as %s elsewhere is not claimed again", async (outcome, how) => {
    const keeper = new LeaseKeeper(transport, clock, renewed());
    answers = [fails(conflict(`lease 1 is ${outcome}`, { outcome }))];
    await keeper.renew();
    await clock.advance(10 * LEASE_MS);
    expect([keeper.state.get(), keeper.lease.id]).toEqual([{ kind: "ended", how }, 1]);
  });

  it("tells that work has begun as often as it takes, then no more", async () => {
    const keeper = new LeaseKeeper(transport, clock, renewed());
    answers = [fails(new Unreachable("cut"))];
    await keeper.renew(false);
    await clock.advance(LEASE_MS / 2);
    expect(told).toEqual([false, false, null]);
  });

  it("tells that work has begun though an older answer was still under way", async () => {
    const keeper = new LeaseKeeper(transport, clock, renewed());
    const asking = keeper.renew();
    await keeper.renew(false);
    await asking;
    await clock.advance(LEASE_MS / 2);
    expect(told).toEqual([null, false, null]);
  });

  it("is let go when stopped, even while an answer is under way", async () => {
    const keeper = new LeaseKeeper(transport, clock, renewed());
    const asking = keeper.renew();
    keeper.stop();
    await asking;
    await settled();
    await clock.advance(10 * LEASE_MS);
    expect(nRenewals).toBe(1);
  });
});
