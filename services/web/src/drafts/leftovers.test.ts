import "fake-indexeddb/auto";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { lockOf } from "./editingRight";
import { IndexedDbOutbox } from "./indexedDbOutbox";
import { type LeftoverParts, Leftovers } from "./leftovers";
import { draftIdentity } from "./outbox";
import { FakeService, fakeBrowser, HandClock, settled, stroke } from "./testing";

let database = 0;
let service: FakeService;
let parts: LeftoverParts;

beforeEach(async () => {
  service = new FakeService();
  parts = {
    transport: service,
    outbox: new IndexedDbOutbox(`leftovers ${database++}`),
    clock: new HandClock(),
    tabs: fakeBrowser(),
  };
  await parts.outbox.add(draftIdentity(service.record), stroke(0));
});

const person = () => service.record.person_id;
const send = (personId = person(), isAtWork = false) => new Leftovers(parts, personId, () => isAtWork).send();
const kept = () => parts.outbox.pending(draftIdentity(service.record).key);

describe("strokes of an earlier visit", () => {
  it("are sent though their shape is not open", async () => {
    await send();
    expect(service.log).toMatchObject([{ id: "stroke 0" }]);
    expect(await kept()).toEqual([]);
  });

  it("are left to the sender of their draft if it is open here", async () => {
    await send(person(), true);
    expect(service.nRequests).toBe(0);
  });

  it("are left to the tab that has their draft open", async () => {
    let release = () => {};
    const editing = new Promise<void>((resolve) => {
      release = resolve;
    });
    const name = lockOf(draftIdentity(service.record).key);
    void parts.tabs.locks?.request(name, {}, () => editing);
    await send();
    expect(service.nRequests).toBe(0);
    release();
    await settled();
    await send();
    expect(service.log).toHaveLength(1);
  });

  it("are not sent twice at once", async () => {
    const leftovers = new Leftovers({ ...parts, tabs: { locks: null } }, person(), () => false);
    await Promise.all([leftovers.send(), leftovers.send()]);
    expect(service.nRequests).toBe(3); // the draft, its strokes, those that are sent
  });

  it("are sent, too, where they were left while others were on their way", async () => {
    let isOpen = true;
    const leftovers: Leftovers = new Leftovers(parts, person(), () => isOpen && leave());
    const leave = () => {
      isOpen = false;
      void leftovers.send();
      return true;
    };
    await leftovers.send();
    expect(await kept()).toEqual([]);
  });

  it("of further drafts are sent though another tab took the right to edit one", async () => {
    const stolen = new DOMException("stolen", "AbortError");
    const request = vi.fn((_name: string) => Promise.reject(stolen));
    parts = { ...parts, tabs: { locks: { request } as never } };
    await parts.outbox.add(
      { ...draftIdentity(service.record), draftId: 8, key: "further" },
      stroke(0, "further"),
    );
    await send();
    expect(request.mock.calls.map(([name]) => name)).toContain(lockOf("further"));
    expect(request).toHaveBeenCalledTimes(2);
  });

  it("are not sent as somebody else's", async () => {
    await send(person() + 1);
    expect(service.nRequests).toBe(0);
  });

  it("stay while the service cannot be reached, and are sent the next time", async () => {
    service.faults = ["cut"];
    await send();
    expect(await kept()).toHaveLength(1);
    await send();
    expect(await kept()).toEqual([]);
  });

  it("keep nobody waiting where the service does not answer", async () => {
    service.faults = ["hangs"];
    const sending = send();
    await settled();
    await (parts.clock as HandClock).advance(60_000);
    await sending;
    expect(await kept()).toHaveLength(1);
  });

  it("stay for their own workspace while another is served", async () => {
    parts = { ...parts, transport: new FakeService("2026-02-02T00:00:00Z") };
    await send();
    expect(await kept()).toHaveLength(1);
  });

  it("stay for the person to choose where the draft went on without them", async () => {
    service.log = [stroke(0, "theirs")];
    await send();
    expect([await kept(), await parts.outbox.asides()]).toMatchObject([[{ id: "stroke 0" }], []]);
  });

  it("are set aside where the draft was closed without them", async () => {
    service.outcome = "confirmed";
    await send();
    expect(await parts.outbox.asides()).toMatchObject([{ reason: "closed", strokes: [{ id: "stroke 0" }] }]);
    expect(await kept()).toEqual([]);
  });

  it("are set aside where the draft was closed after it went on without them", async () => {
    service.outcome = "confirmed";
    service.log = [stroke(0, "theirs")];
    await send();
    expect(await parts.outbox.asides()).toMatchObject([{ before: [], strokes: [{ id: "stroke 0" }] }]);
  });
});
