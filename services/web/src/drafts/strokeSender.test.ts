import "fake-indexeddb/auto";
import { beforeEach, describe, expect, it } from "vitest";
import { IndexedDbOutbox } from "./indexedDbOutbox";
import { draftIdentity } from "./outbox";
import { StrokeSender } from "./strokeSender";
import { FakeService, type Fault, HandClock, problem, settled, stroke } from "./testing";

let database = 0;
let service: FakeService;
let clock: HandClock;
let outbox: IndexedDbOutbox;

beforeEach(() => {
  service = new FakeService();
  clock = new HandClock();
  outbox = new IndexedDbOutbox(`test ${database++}`);
});

/** A tab that has just been opened, as after a reload. */
async function opened(): Promise<StrokeSender> {
  const sender = new StrokeSender({ transport: service, outbox, clock }, draftIdentity(service.record));
  await sender.adopt(async () => [...service.log]);
  sender.resume();
  await settled();
  return sender;
}

const ids = (strokes: readonly { id: string }[]) => strokes.map((each) => each.id);
const kept = () => outbox.pending(draftIdentity(service.record).key);

describe("on a good connection", () => {
  it("brings strokes to the service in order and empties the outbox", async () => {
    const sender = await opened();
    for (const sequence of [0, 1, 2]) sender.append(stroke(sequence));
    expect(sender.state.get()).toMatchObject({ kind: "saving", nQueued: 3 });
    await settled();
    expect(ids(service.log)).toEqual(["stroke 0", "stroke 1", "stroke 2"]);
    expect(sender.state.get().kind).toBe("saved");
    expect(await kept()).toEqual([]);
  });

  it("keeps a stroke in the outbox before it sends it", async () => {
    const sender = await opened();
    service.faults = ["hangs"];
    sender.append(stroke(0));
    await settled();
    expect(ids(await kept())).toEqual(["stroke 0"]);
  });

  it("refuses a stroke that does not follow on the log", async () => {
    const sender = await opened();
    expect(() => sender.append(stroke(1))).toThrow(RangeError);
  });
});

describe("failures", () => {
  it.each<Fault>(["cut", "lost", "busy", "hangs"])(
    "a request that is %s is sent again, once is on record",
    async (fault) => {
      const sender = await opened();
      service.faults = [fault];
      sender.append(stroke(0));
      sender.append(stroke(1));
      await settled();
      await clock.advance(120_000);
      expect(ids(service.log)).toEqual(["stroke 0", "stroke 1"]);
      expect(sender.state.get().kind).toBe("saved");
    },
  );

  it("says how many strokes wait while the service cannot be reached", async () => {
    const sender = await opened();
    service.faults = ["cut"];
    sender.append(stroke(0));
    await settled();
    expect(sender.state.get()).toMatchObject({ kind: "offline", nQueued: 1, isKept: true });
  });

  it("calls a stroke queued only once it outlives the tab", async () => {
    const sender = await opened();
    service.faults = ["cut"];
    sender.append(stroke(0));
    await settled();
    sender.append(stroke(1));
    expect(sender.state.get().kind).toBe("saving");
    service.faults = ["cut"];
    await settled();
    expect(sender.state.get()).toMatchObject({ kind: "offline", nQueued: 2 });
    expect(ids(await kept())).toEqual(["stroke 0", "stroke 1"]);
  });

  it("waits longer from try to try", async () => {
    const sender = await opened();
    service.faults = Array<Fault>(100).fill("cut");
    sender.append(stroke(0));
    await clock.advance(60_000);
    const inAMinute = service.nRequests;
    await clock.advance(600_000);
    expect(inAMinute).toBeLessThan(12);
    expect(service.nRequests - inAMinute).toBeLessThan(40);
  });

  it("waits for the person to log in again, then goes on", async () => {
    const sender = await opened();
    service.faults = ["signed-out"];
    sender.append(stroke(0));
    await clock.advance(600_000);
    expect(sender.state.get()).toMatchObject({ kind: "signed-out", nQueued: 1 });
    sender.resume();
    await settled();
    expect(service.log).toHaveLength(1);
  });

  it("misses nothing that another sender brings to the service while the log is taken up", async () => {
    const identity = draftIdentity(service.record);
    await outbox.add(identity, stroke(0));
    const sender = new StrokeSender({ transport: service, outbox, clock }, identity);
    await sender.adopt(async () => {
      await opened(); // and sends what was kept
      return [...service.log];
    });
    expect(ids(sender.strokes)).toEqual(["stroke 0"]);
    expect([ids(service.log), sender.state.get().kind]).toEqual([["stroke 0"], "saved"]);
  });

  it("survives a reload in the middle of sending", async () => {
    const before = await opened();
    service.faults = ["lost", "cut", "cut"];
    for (const sequence of [0, 1, 2]) before.append(stroke(sequence));
    await settled();
    await before.pause();
    const after = await opened();
    await clock.advance(60_000);
    expect(ids(after.strokes)).toEqual(["stroke 0", "stroke 1", "stroke 2"]);
    expect(ids(service.log)).toEqual(["stroke 0", "stroke 1", "stroke 2"]);
    expect(await kept()).toEqual([]);
  });

  it("sends from memory where the browser has no room, and says so", async () => {
    outbox.add = () => Promise.reject(new DOMException("full", "QuotaExceededError"));
    const sender = await opened();
    service.faults = ["cut"];
    sender.append(stroke(0));
    await settled();
    expect(sender.state.get()).toMatchObject({ kind: "offline", isKept: false });
    await clock.advance(10_000);
    expect(service.log).toHaveLength(1);
    expect(sender.state.get().kind).toBe("saved");
  });

  it("sends again what a service restored from a backup has lost", async () => {
    const sender = await opened();
    for (const sequence of [0, 1, 2]) sender.append(stroke(sequence));
    await settled();
    service.log = service.log.slice(0, 1);
    sender.append(stroke(3));
    await settled();
    expect(ids(service.log)).toEqual(["stroke 0", "stroke 1", "stroke 2", "stroke 3"]);
  });

  it("does not send what the service refuses again and again; withdrawing sets it aside", async () => {
    const sender = await opened();
    service.append = () => Promise.reject(problem(422, "invalid", "no such part"));
    sender.append(stroke(0));
    await clock.advance(600_000);
    expect(sender.state.get()).toMatchObject({ kind: "refused", why: "no such part" });
    await sender.withdraw();
    expect(sender.strokes).toEqual([]);
    expect((await outbox.asides())[0]).toMatchObject({
      reason: "refused",
      before: [],
      strokes: [{ id: "stroke 0" }],
    });
  });

  it("keeps strokes of a draft that was confirmed elsewhere", async () => {
    const sender = await opened();
    service.outcome = "confirmed";
    sender.append(stroke(0));
    await settled();
    expect(sender.state.get().kind).toBe("closed");
    await sender.withdraw();
    expect((await outbox.asides())[0]).toMatchObject({ reason: "closed", strokes: [{ id: "stroke 0" }] });
    expect(await kept()).toEqual([]);
    expect(sender.state.get()).toMatchObject({ kind: "closed", nQueued: 0 }); // it would take no other stroke
  });

  it("does not take another workspace's draft of the same number for its own", async () => {
    const before = await opened();
    service.faults = ["cut"];
    before.append(stroke(0));
    await settled();
    await before.pause();
    service = new FakeService("2026-02-02T00:00:00Z");
    const after = await opened();
    await clock.advance(60_000);
    expect(after.strokes).toEqual([]);
    expect(service.log).toEqual([]);
  });
});

describe("a draft that went on elsewhere", () => {
  it("follows where nothing here contradicts it", async () => {
    const sender = await opened();
    let nReplaced = 0;
    sender.onReplaced = () => nReplaced++;
    service.log = [stroke(0, "theirs 0"), stroke(1, "theirs 1")];
    await sender.refresh();
    expect(ids(sender.strokes)).toEqual(["theirs 0", "theirs 1"]);
    expect(nReplaced).toBe(1);
  });

  async function inConflict(): Promise<StrokeSender> {
    const sender = await opened();
    sender.append(stroke(0));
    await settled();
    service.log.push(stroke(1, "theirs 1"), stroke(2, "theirs 2"));
    sender.append(stroke(1, "mine 1"));
    await settled();
    return sender;
  }

  it("shows both sides and sends nothing until the person chooses", async () => {
    const sender = await inConflict();
    const state = sender.state.get();
    if (state.kind !== "conflict") throw new Error(state.kind);
    expect(state.divergence.common).toBe(1);
    expect(ids(state.divergence.mine)).toEqual(["mine 1"]);
    expect(ids(state.divergence.theirs)).toEqual(["theirs 1", "theirs 2"]);
    const { nRequests } = service;
    sender.resume();
    await clock.advance(600_000);
    expect(service.nRequests).toBe(nRequests);
  });

  it("is found after a reload, too", async () => {
    const before = await inConflict();
    await before.pause();
    expect((await opened()).state.get()).toMatchObject({ kind: "conflict", divergence: { common: 1 } });
  });

  it("taking theirs sets mine aside", async () => {
    const sender = await inConflict();
    await sender.takeTheirs();
    expect(ids(sender.strokes)).toEqual(["stroke 0", "theirs 1", "theirs 2"]);
    expect(sender.state.get().kind).toBe("saved");
    expect(await outbox.asides()).toMatchObject([
      { before: [{ id: "stroke 0" }], reason: "took-theirs", strokes: [{ id: "mine 1" }] },
    ]);
    expect(await kept()).toEqual([]);
  });

  it("keeping mine puts new strokes on top of theirs", async () => {
    const sender = await inConflict();
    await sender.keepMine([stroke(3, "mine again")]);
    await settled();
    expect(ids(service.log)).toEqual(["stroke 0", "theirs 1", "theirs 2", "mine again"]);
    expect(sender.state.get().kind).toBe("saved");
    expect(await kept()).toEqual([]);
  });

  it("sets aside what two windows kept for one place", async () => {
    const identity = draftIdentity(service.record);
    await outbox.add(identity, stroke(0, "a"));
    await outbox.add(identity, stroke(0, "b"));
    const sender = await opened();
    expect(ids(sender.strokes)).toEqual(["a"]);
    expect(await outbox.asides()).toMatchObject([{ reason: "two-windows", strokes: [{ id: "b" }] }]);
  });
});

describe("any sequence of failures", () => {
  const FAULTS: readonly Fault[] = ["cut", "lost", "busy", "hangs", "signed-out"];

  it.each(Array.from({ length: 40 }, (_, seed) => seed))(
    "ends with every stroke on record once, in order (seed %i)",
    async (seed) => {
      const chance = chanceOf(seed);
      let sender = await opened();
      let n = 0;
      for (let turn = 0; turn < 25; turn++) {
        const draw = chance();
        if (draw < 0.45) sender.append(stroke(n++));
        else if (draw < 0.7) service.faults.push(FAULTS[Math.floor(chance() * FAULTS.length)] as Fault);
        else if (draw < 0.8) sender.resume();
        else if (draw < 0.9) await clock.advance(chance() * 20_000);
        else {
          await sender.pause(); // what is not stored by then was never shown as done
          sender = await opened();
        }
      }
      service.faults = [];
      sender.resume();
      await clock.advance(120_000);
      expect(ids(service.log)).toEqual(Array.from({ length: n }, (_, sequence) => `stroke ${sequence}`));
      expect(ids(sender.strokes)).toEqual(ids(service.log));
      expect(sender.state.get().kind).toBe("saved");
      expect(await kept()).toEqual([]);
    },
  );
});

/** Numbers from 0 to 1 that are the same for the same seed (mulberry32). */
function chanceOf(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let mixed = Math.imul(state ^ (state >>> 15), 1 | state);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 4_294_967_296;
  };
}
