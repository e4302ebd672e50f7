import "fake-indexeddb/auto";
import { beforeEach, describe, expect, it } from "vitest";
import { IndexedDbOutbox } from "./indexedDbOutbox";
import { sendLeftovers } from "./leftovers";
import { draftIdentity } from "./outbox";
import type { SenderParts } from "./strokeSender";
import { FakeService, HandClock, stroke } from "./testing";

let database = 0;
let service: FakeService;
let parts: SenderParts;

beforeEach(async () => {
  service = new FakeService();
  parts = {
    transport: service,
    outbox: new IndexedDbOutbox(`leftovers ${database++}`),
    clock: new HandClock(),
  };
  await parts.outbox.add(draftIdentity(service.record), stroke(0));
});

const person = () => service.record.person_id;
const kept = () => parts.outbox.pending(draftIdentity(service.record).key);

describe("strokes of an earlier visit", () => {
  it("are sent though their shape is not open", async () => {
    await sendLeftovers(parts, person(), new Set());
    expect(service.log).toMatchObject([{ id: "stroke 0" }]);
    expect(await kept()).toEqual([]);
  });

  it("are left to the sender of their draft if it is open", async () => {
    await sendLeftovers(parts, person(), new Set([draftIdentity(service.record).key]));
    expect(service.nRequests).toBe(0);
  });

  it("are not sent as somebody else's", async () => {
    await sendLeftovers(parts, person() + 1, new Set());
    expect(service.nRequests).toBe(0);
  });

  it("stay while the service cannot be reached", async () => {
    service.faults = ["cut"];
    await sendLeftovers(parts, person(), new Set());
    expect(await kept()).toHaveLength(1);
  });

  it("stay for their own workspace while another is served", async () => {
    parts = { ...parts, transport: new FakeService("2026-02-02T00:00:00Z") };
    await sendLeftovers(parts, person(), new Set());
    expect(await kept()).toHaveLength(1);
  });

  it("are set aside where the draft went on or was closed without them", async () => {
    service.log = [stroke(0, "theirs")];
    await sendLeftovers(parts, person(), new Set());
    expect(await parts.outbox.asides()).toMatchObject([
      { reason: "took-theirs", strokes: [{ id: "stroke 0" }] },
    ]);
    service.log = [];
    service.outcome = "confirmed";
    await parts.outbox.add(draftIdentity(service.record), stroke(0));
    await sendLeftovers(parts, person(), new Set());
    expect((await parts.outbox.asides())[1]).toMatchObject({ reason: "closed" });
  });
});
