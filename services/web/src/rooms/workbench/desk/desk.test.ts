import { beforeEach, describe, expect, it } from "vitest";
import { Unreachable } from "../../../api/problem";
import type { ConfirmOutcome } from "../../../drafts/confirming";
import type { Lease, LeaseApi } from "../../../drafts/leaseApi";
import type { Renewed } from "../../../drafts/leaseKeeper";
import { Observable } from "../../../drafts/observable";
import type { DraftIdentity } from "../../../drafts/outbox";
import { conflict, settled } from "../../../drafts/testing";
import { Desk } from "./desk";
import type { HeldShape, HeldState } from "./heldShape";

/** A queue that one person works on, as the service keeps it. */
class FakeQueue {
  waiting = [1, 2, 3];
  held: { shapeId: number; isPrefetched: boolean }[] = [];
  isDown = false;
  /** Does not answer for now. */
  isSlow = false;
  /** Does not say what is held. */
  isHeldUnknown = false;

  readonly api = {
    held: async () => {
      if (this.isHeldUnknown) throw new Unreachable("down");
      return this.held.map(({ shapeId, isPrefetched }) => leased(shapeId, isPrefetched));
    },
    next: async (_collection: number, isPrefetch: boolean) => {
      if (this.isDown) throw new Unreachable("down");
      const ahead = this.held.find((each) => each.isPrefetched);
      if (ahead !== undefined) {
        ahead.isPrefetched = isPrefetch;
        return leased(ahead.shapeId, isPrefetch);
      }
      const shapeId = this.waiting.shift();
      if (shapeId === undefined) return null;
      this.held.push({ shapeId, isPrefetched: isPrefetch });
      return leased(shapeId, isPrefetch);
    },
    named: async (_collection: number, shapeIds: number[]) => {
      if (this.isDown) throw new Unreachable("down");
      const free = shapeIds.filter((id) => this.waiting.includes(id));
      if (free.length === 0) throw conflict("shape is with Ben");
      this.waiting = this.waiting.filter((id) => !free.includes(id));
      this.held.push(...free.map((shapeId) => ({ shapeId, isPrefetched: false })));
      const refused = shapeIds
        .filter((id) => !free.includes(id))
        .map((shape_id) => ({ shape_id, why: "taken" }));
      return { leases: free.map((id) => leased(id, false)), refused };
    },
    skip: async (leaseId: number) => this.end(leaseId),
    release: async (leaseId: number) => this.end(leaseId),
  } as unknown as LeaseApi;

  end(shapeId: number): void {
    this.held = this.held.filter((each) => each.shapeId !== shapeId);
  }
}

function leased(shapeId: number, isPrefetched: boolean): Renewed<Lease> {
  const lease = { id: shapeId, shape_id: shapeId, collection_id: 9, is_prefetched: isPrefetched } as Lease;
  return { lease, at: 0 };
}

let queue: FakeQueue;
let outcome: ConfirmOutcome;
let loaded: number[];
let closed: number[];
let taken: number[];
let stopped: number[];

beforeEach(() => {
  queue = new FakeQueue();
  outcome = { kind: "confirmed" };
  loaded = [];
  closed = [];
  taken = [];
  stopped = [];
});

function held({ lease }: Renewed<Lease>): HeldShape {
  const confirm = async () => {
    if (outcome.kind === "confirmed") queue.end(lease.shape_id);
    return outcome;
  };
  return {
    lease,
    shapeId: lease.shape_id,
    state: new Observable({ step: "mesh" } as HeldState),
    keeper: {
      renew: async () => {},
      stop: () => stopped.push(lease.shape_id),
      state: { get: () => ({ kind: taken.includes(lease.shape_id) ? "ended" : "held" }) },
    },
    open: { confirm, draft: { sender: { draft: { key: "now" } } } },
    load: () => loaded.push(lease.shape_id),
    begin: async () => {},
    seen: async () => {},
    takenUp: async () => {
      if (queue.isSlow) await new Promise(() => {});
      const own = queue.held.find((each) => each.shapeId === lease.shape_id);
      if (own !== undefined) own.isPrefetched = false;
    },
    close: async () => closed.push(lease.shape_id),
  } as unknown as HeldShape;
}

async function started(named: number[] = []): Promise<Desk> {
  const desk = new Desk({ leases: queue.api, hold: held }, 9, () => ({ partIds: [1], start: "best" }));
  await desk.start(named);
  await settled();
  return desk;
}

const current = (desk: Desk) => desk.state.get().current?.shapeId ?? null;
const inHand = (desk: Desk) => desk.state.get().shapes.map((shape) => shape.shapeId);

describe("a desk", () => {
  it("takes the next of the queue, and loads the one after it ahead", async () => {
    const desk = await started();
    expect(current(desk)).toBe(1);
    expect(inHand(desk)).toEqual([1]);
    expect(loaded).toEqual([1, 2]);
  });

  it("has the same shapes after a reload", async () => {
    await started();
    const desk = await started();
    expect(inHand(desk)).toEqual([1]);
    expect(queue.waiting).toEqual([3]);
  });

  it("shows what was loaded ahead once a shape is confirmed", async () => {
    const desk = await started();
    await desk.confirm(desk.state.get().current as HeldShape);
    expect(current(desk)).toBe(2);
    await settled();
    expect(loaded).toEqual([1, 2, 3]);
    expect(closed).toEqual([1]);
  });

  it("stays where it is if a shape could not be confirmed", async () => {
    const desk = await started();
    outcome = { kind: "unsaved" };
    expect(await desk.confirm(desk.state.get().current as HeldShape)).toEqual({ kind: "unsaved" });
    expect(current(desk)).toBe(1);
  });

  it("goes on to the next after a skip", async () => {
    const desk = await started();
    await desk.skip(desk.state.get().current as HeldShape, "broken");
    expect(current(desk)).toBe(2);
  });

  it("tells that a shape is off it once its draft is closed", async () => {
    const desk = await started();
    const closedThen: number[][] = [];
    desk.onLeft = () => closedThen.push([...closed]);
    await desk.leave(desk.state.get().current as HeldShape);
    expect(closedThen).toEqual([[1]]);
  });

  it("renews a shape no more once it is given back, though the next one is still on its way", async () => {
    const desk = await started();
    queue.isSlow = true;
    void desk.skip(desk.state.get().current as HeldShape, "broken");
    await settled();
    expect([current(desk), stopped, closed]).toEqual([2, [1], []]);
  });

  it("is empty once nothing is left", async () => {
    queue.waiting = [1];
    const desk = await started();
    await desk.confirm(desk.state.get().current as HeldShape);
    expect(desk.state.get()).toMatchObject({ phase: "empty", current: null, shapes: [] });
  });

  it("takes shapes by name, and says which are not to be had", async () => {
    const desk = await started([3, 7]);
    expect(current(desk)).toBe(3);
    expect(desk.state.get().refused).toEqual([{ shape_id: 7, why: "taken" }]);
  });

  it("takes one more by its name, wherever it is by then", async () => {
    const desk = await started();
    await desk.takeNamed(3);
    expect([current(desk), inHand(desk)]).toEqual([3, [1, 3]]);
    await desk.takeNamed(1);
    expect([current(desk), inHand(desk)]).toEqual([1, [1, 3]]);
    await desk.takeNamed(2); // which was loaded ahead
    expect([current(desk), inHand(desk)]).toEqual([2, [1, 3, 2]]);
    await desk.takeNamed(7);
    expect(current(desk)).toBe(2);
    expect(desk.state.get().refused).toEqual([{ shape_id: 7, why: "shape is with Ben" }]);
  });

  it("hands out nothing instead of a shape that is not to be had", async () => {
    const desk = await started([7]);
    expect(desk.state.get()).toMatchObject({ phase: "failed", why: "shape is with Ben" });
    expect(queue.held).toEqual([]);
  });

  it("says why there is no shape, and takes one when asked again", async () => {
    queue.isDown = true;
    const desk = await started();
    expect(desk.state.get().phase).toBe("failed");
    queue.isDown = false;
    await desk.takeNext();
    expect(current(desk)).toBe(1);
  });

  it("shows a shape that it was given by name, though it is not told what else is held", async () => {
    queue.isHeldUnknown = true;
    const desk = await started([3, 7]);
    expect(desk.state.get().phase).toBe("working");
    expect([current(desk), inHand(desk)]).toEqual([3, [3]]);
    expect(desk.state.get().refused).toEqual([{ shape_id: 7, why: "taken" }]);
  });

  it("asks for the same shapes again where none could be had", async () => {
    queue.isDown = true;
    const desk = await started([3, 2]);
    queue.isDown = false;
    const starting = desk.startAgain();
    expect(desk.state.get().phase).toBe("opening");
    await starting;
    expect([current(desk), inHand(desk)]).toEqual([3, [3, 2]]);
  });

  it("asks no more for shapes that it had, once they are done", async () => {
    queue.waiting = [3, 1];
    const desk = await started([3]);
    await desk.skip(desk.state.get().current as HeldShape, "broken");
    queue.isDown = true;
    await desk.skip(desk.state.get().current as HeldShape, "broken");
    expect(desk.state.get().phase).toBe("failed");
    queue.isDown = false;
    queue.waiting = [2, 3];
    await desk.startAgain();
    expect(current(desk)).toBe(2);
  });

  it("keeps a shape that was taken away in sight, but not one that was only loaded ahead", async () => {
    const desk = await started();
    taken = [1, 2];
    queue.end(2);
    await desk.recheck(1);
    await desk.recheck(2);
    await settled();
    expect([inHand(desk), closed]).toEqual([[1], [2]]);
    await desk.takeNext();
    expect(inHand(desk)).toEqual([1, 3]);
  });

  it("hears nothing of shapes that are not on it", async () => {
    const desk = await started();
    await desk.recheck(77);
    expect(closed).toEqual([]);
  });

  it("is at work on drafts of its shapes, before it knows them and while they are opened, too", async () => {
    const of = (shapeId: number, key: string) => ({ shapeId, key }) as DraftIdentity;
    const desk = new Desk({ leases: queue.api, hold: held }, 9, () => ({ partIds: [1], start: "best" }));
    const starting = desk.start([]);
    expect(desk.isAtWork(of(77, "any"))).toBe(true);
    await starting;
    await settled();
    expect(desk.isAtWork(of(77, "any"))).toBe(false);
    expect([desk.isAtWork(of(1, "now")), desk.isAtWork(of(1, "before"))]).toEqual([true, false]);
    Object.assign(desk.state.get().current as HeldShape, { open: null });
    expect(desk.isAtWork(of(1, "before"))).toBe(true);
  });

  it("claims nothing when it is closed at once", async () => {
    const desk = new Desk({ leases: queue.api, hold: held }, 9, () => ({ partIds: [1], start: "best" }));
    const starting = desk.start([]);
    await desk.close();
    await starting;
    expect(queue.waiting).toEqual([1, 2, 3]);
  });
});
