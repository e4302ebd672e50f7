import "fake-indexeddb/auto";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { IndexedDbOutbox } from "./indexedDbOutbox";
import { draftIdentity, fits } from "./outbox";
import { DEVICE_PATIENCE_MS, ReserveOutbox } from "./reserveOutbox";
import { StrokeSender } from "./strokeSender";
import { FakeService, HandClock, settled, stroke } from "./testing";

let database = 0;
let service: FakeService;
let clock: HandClock;
let device: IndexedDbOutbox;
let outbox: ReserveOutbox;

beforeEach(() => {
  service = new FakeService();
  clock = new HandClock();
  device = new IndexedDbOutbox(`reserve ${database++}`);
  outbox = new ReserveOutbox(device, clock);
});

const draft = () => draftIdentity(service.record);
const aside = () => ({ draft: draft(), before: [], at: 0, reason: "closed" as const, strokes: [stroke(0)] });
const full = () => Promise.reject(new DOMException("full", "QuotaExceededError"));
const NEVER = () => new Promise<never>(() => {});

function breakDevice(fails: () => Promise<never> = full): void {
  for (const name of ["add", "pending", "remove", "replace", "setAside", "asides", "drafts"] as const) {
    vi.spyOn(device, name).mockImplementation(fails);
  }
}

async function opened(): Promise<StrokeSender> {
  const sender = new StrokeSender({ transport: service, outbox, clock }, draft());
  await sender.adopt(async () => [...service.log]);
  sender.resume();
  await settled();
  return sender;
}

async function inConflict(): Promise<StrokeSender> {
  const sender = await opened();
  service.log = [stroke(0, "theirs")];
  sender.append(stroke(0, "mine"));
  await settled();
  expect(sender.state.get().kind).toBe("conflict");
  return sender;
}

describe("a device that keeps what it is given", () => {
  it("leaves nothing in memory", async () => {
    const adding = outbox.add(draft(), stroke(0));
    expect(outbox.isEmpty).toBe(false);
    await adding;
    await outbox.setAside(aside());
    expect(outbox.isEmpty).toBe(true);
    expect(await outbox.asides()).toEqual(await device.asides());
  });
});

describe("a device without room", () => {
  beforeEach(() => breakDevice());

  it("has strokes kept in memory until they are sent", async () => {
    await expect(outbox.add(draft(), stroke(0))).rejects.toThrow("full");
    expect(await outbox.pending(draft().key)).toEqual([stroke(0)]);
    expect(await outbox.drafts()).toEqual([draft()]);
    await outbox.remove(draft().key, [stroke(0)]).catch(() => {});
    expect(outbox.isEmpty).toBe(true);
  });

  it("has versions that are set aside kept in memory until they are dropped", async () => {
    await outbox.setAside(aside());
    const [kept] = await outbox.asides();
    expect(kept).toMatchObject(aside());
    expect(outbox.isEmpty).toBe(false);
    await outbox.forgetAside(kept?.id ?? 0);
    expect([await outbox.asides(), outbox.isEmpty]).toEqual([[], true]);
  });

  it("is given versions that were set aside once it has room again", async () => {
    await outbox.setAside(aside());
    vi.restoreAllMocks();
    await outbox.storeAgain();
    expect([outbox.isEmpty, await outbox.asides()]).toEqual([true, [{ ...aside(), id: 1 }]]);
  });

  it("keeps nobody from settling a conflict", async () => {
    const one = await inConflict();
    await one.takeTheirs();
    expect(one.state.get().kind).toBe("saved");
    expect(await outbox.asides()).toMatchObject([{ strokes: [{ id: "mine" }] }]);

    service = new FakeService("2026-02-02T00:00:00Z");
    const other = await inConflict();
    await other.keepMine([stroke(1, "mine again")]);
    await settled();
    expect(other.state.get().kind).toBe("saved");
    expect(service.log).toHaveLength(2);
  });

  it("is asked again once something may work again", async () => {
    const sender = await opened();
    service.faults = ["cut", "cut"];
    sender.append(stroke(0));
    await settled();
    expect(sender.state.get()).toMatchObject({ kind: "offline", isKept: false });
    vi.restoreAllMocks();
    sender.wake();
    await settled();
    expect(sender.state.get()).toMatchObject({ kind: "offline", isKept: true });
    expect([outbox.isEmpty, await device.pending(draft().key)]).toEqual([true, [stroke(0)]]);
  });
});

describe("a device that does not answer", () => {
  beforeEach(() => breakDevice(NEVER));

  it("is given a version once, however often it is asked to take it", async () => {
    const setting = outbox.setAside(aside());
    await clock.advance(DEVICE_PATIENCE_MS);
    await setting;
    await outbox.storeAgain();
    expect(device.setAside).toHaveBeenCalledOnce();
  });

  it("does not keep strokes from being sent", async () => {
    const opening = opened();
    await clock.advance(DEVICE_PATIENCE_MS);
    const sender = await opening;
    sender.append(stroke(0));
    await settled();
    expect(service.log).toEqual([]);
    await clock.advance(DEVICE_PATIENCE_MS);
    expect(service.log).toEqual([stroke(0)]);
  });
});

describe("what was set aside", () => {
  it("fits the same person's drafts on the same mesh of the same shape", () => {
    const later = { ...draft(), draftId: 8, key: "another" };
    expect(fits(aside(), later)).toBe(true);
    expect(fits(aside(), { ...later, personId: 99 })).toBe(false);
    expect(fits(aside(), { ...later, shapeId: 99 })).toBe(false);
    expect(fits(aside(), { ...later, meshHash: "another" })).toBe(false);
  });
});

describe("the browser", () => {
  it("is asked once not to clear what is kept, at the first stroke", async () => {
    const persist = vi.fn(async () => true);
    vi.stubGlobal("navigator", { storage: { persist } });
    await device.pending(draft().key);
    expect(persist).not.toHaveBeenCalled();
    await device.add(draft(), stroke(0));
    await device.add(draft(), stroke(1));
    vi.unstubAllGlobals();
    expect(persist).toHaveBeenCalledOnce();
  });
});
