import "fake-indexeddb/auto";
import { beforeEach, describe, expect, it } from "vitest";
import type { StrokeJson } from "../labels/strokes";
import { DraftSession, type SessionParts } from "./draftSession";
import type { Tabs } from "./editingRight";
import { IndexedDbOutbox } from "./indexedDbOutbox";
import { LeaseKeeper, type LeaseRecord } from "./leaseKeeper";
import { FakeService, fakeBrowser, HandClock, problem, settled, stroke } from "./testing";

let database = 0;
let service: FakeService;
let clock: HandClock;
let parts: SessionParts;

beforeEach(() => {
  service = new FakeService();
  clock = new HandClock();
  parts = partsIn(fakeBrowser());
});

function partsIn(tabs: Tabs): SessionParts {
  const outbox = new IndexedDbOutbox(`session ${database++}`);
  return { transport: service, outbox, clock, tabs, openDraft: async () => service.record };
}

interface Tab {
  readonly session: DraftSession;
  /** Strokes as this tab shows them. */
  shown: StrokeJson[];
}

async function tab(own: SessionParts = parts): Promise<Tab> {
  const lease: LeaseRecord = {
    id: 1,
    shape_id: 3,
    collection_id: 1,
    acquired_at: "",
    expires_at: "2026-01-01T00:05:00Z",
  };
  const renewed = { lease, at: Date.parse("2026-01-01T00:00:00Z") };
  const transport = { renew: async () => renewed, reclaim: async () => renewed };
  const session = await DraftSession.open(own, new LeaseKeeper(transport, clock, renewed), null);
  const opened: Tab = { session, shown: [...session.strokes] };
  session.listener = {
    onReplaced: () => {
      opened.shown = [...session.strokes];
    },
    onFollowed: (followed) => opened.shown.push(followed),
  };
  await settled();
  return opened;
}

function draw({ session, shown }: Tab, id?: string): void {
  const next = stroke(session.strokes.length, id);
  session.append(next);
  shown.push(next);
}

const ids = (strokes: readonly StrokeJson[]) => strokes.map((each) => each.id);

describe("two tabs on one shape", () => {
  it("one edits, the other watches and follows", async () => {
    const [first, second] = [await tab(), await tab()];
    draw(first);
    draw(first);
    await settled();
    expect(first.session.right.role.get()).toBe("editing");
    expect(second.session.right.role.get()).toBe("watching");
    expect(ids(second.shown)).toEqual(["stroke 0", "stroke 1"]);
    expect(() => draw(second)).toThrow("take over");
  });

  it("taking over hands on strokes that are not on record yet", async () => {
    const [first, second] = [await tab(), await tab()];
    service.faults = Array(20).fill("cut");
    draw(first);
    await settled();
    await second.session.right.takeOver();
    await settled();
    expect(first.session.right.role.get()).toBe("watching");
    draw(second);
    service.faults = [];
    await clock.advance(60_000);
    expect(ids(service.log)).toEqual(["stroke 0", "stroke 1"]);
    expect(ids(first.shown)).toEqual(["stroke 0", "stroke 1"]);
  });

  it("takes over from a tab that does not answer", async () => {
    const [first, second] = [await tab(), await tab()];
    first.session.right.beforeHandOver = () => new Promise(() => {});
    const taking = second.session.right.takeOver();
    await clock.advance(5_000);
    await taking;
    expect(second.session.right.role.get()).toBe("editing");
  });

  it("edits once the other tab has gone", async () => {
    const [first, second] = [await tab(), await tab()];
    draw(first);
    await first.session.close();
    await settled();
    expect(second.session.right.role.get()).toBe("editing");
    draw(second);
    await settled();
    expect(ids(service.log)).toEqual(["stroke 0", "stroke 1"]);
  });

  it("watching, has no conflict of its own once the other has settled one", async () => {
    const [first, second] = [await tab(), await tab()];
    draw(first);
    await settled();
    service.log.push(stroke(1, "theirs 1"));
    draw(first, "mine 1");
    await settled();
    expect(first.session.sender.state.get().kind).toBe("conflict");
    await first.session.sender.takeTheirs();
    await settled();
    expect(second.session.sender.state.get().kind).toBe("saved");
    expect(ids(second.shown)).toEqual(["stroke 0", "theirs 1"]);
  });

  it("one that could not open the draft keeps no channel to the others", async () => {
    const { tabs } = parts;
    let nChannels = 0;
    const channel = (name: string) => {
      const opened = tabs.channel(name);
      nChannels++;
      return Object.assign(opened, { close: () => nChannels-- });
    };
    service.faults = ["cut"];
    await expect(tab({ ...parts, tabs: { ...tabs, channel } })).rejects.toThrow("cannot be reached");
    expect(nChannels).toBe(0);
  });

  it("learns that the other confirmed the shape", async () => {
    const [first, second] = [await tab(), await tab()];
    draw(first);
    await first.session.confirm("sum");
    await settled();
    expect(second.session.isConfirmedElsewhere.get()).toBe(true);
  });
});

describe("two browsers on one shape", () => {
  it("the one without strokes of its own follows", async () => {
    const [first, second] = [await tab(partsIn(fakeBrowser())), await tab(partsIn(fakeBrowser()))];
    draw(first, "a");
    await settled();
    await second.session.sender.refresh();
    expect(ids(second.shown)).toEqual(["a"]);
  });

  it("of two that both wrote, the later is asked, and nothing is lost", async () => {
    const [first, second] = [await tab(partsIn(fakeBrowser())), await tab(partsIn(fakeBrowser()))];
    draw(first, "a");
    await settled();
    draw(second, "b");
    await settled();
    expect(ids(service.log)).toEqual(["a"]);
    expect(second.session.sender.state.get()).toMatchObject({ kind: "conflict", nQueued: 1, isKept: true });
  });
});

describe("without locks", () => {
  it("both tabs may edit, and hear of each other's strokes", async () => {
    const shared = { ...fakeBrowser(), locks: null };
    const own = { ...parts, tabs: shared };
    const [first, second] = [await tab(own), await tab(own)];
    draw(first);
    await settled();
    draw(second);
    await settled();
    expect(ids(service.log)).toEqual(["stroke 0", "stroke 1"]);
    expect(ids(first.shown)).toEqual(["stroke 0", "stroke 1"]);
  });
});

describe("confirming", () => {
  it("sends what waits first", async () => {
    const { session } = await tab();
    service.faults = ["cut"];
    session.append(stroke(0));
    await settled();
    expect(await session.confirm("sum")).toEqual({ kind: "confirmed" });
    expect(service.log).toHaveLength(1);
    expect(service.confirmedAs).toBe("sum");
  });

  it("does not happen while strokes cannot be sent", async () => {
    const { session } = await tab();
    service.faults = ["cut", "cut"];
    session.append(stroke(0));
    await settled();
    expect(await session.confirm("sum")).toEqual({ kind: "unsaved" });
    expect(service.outcome).toBeNull();
  });

  it("may be repeated after its answer was lost", async () => {
    const { session } = await tab();
    service.faults = ["lost"];
    expect((await session.confirm("sum")).kind).toBe("unreachable");
    expect(await session.confirm("sum")).toEqual({ kind: "confirmed" });
  });

  it("asks to look at labels that somebody else confirmed, and goes on once they were seen", async () => {
    const { session } = await tab();
    service.head = 12;
    const outcome = await session.confirm("sum");
    expect(outcome).toMatchObject({ kind: "unseen-labels", revisionId: 12 });
    await session.acknowledge(12);
    expect(await session.confirm("sum")).toEqual({ kind: "confirmed" });
  });

  it("shows strokes made elsewhere before they are confirmed", async () => {
    const { session, shown } = await tab();
    service.log.push(stroke(0, "theirs"));
    expect((await session.confirm("sum")).kind).toBe("went-on");
    expect(ids(session.strokes)).toEqual(["theirs"]);
    expect(shown).toEqual([]);
    expect(await session.confirm("sum")).toEqual({ kind: "confirmed" });
  });

  it("says what else the service has against it", async () => {
    const { session } = await tab();
    service.confirm = () => Promise.reject(problem(422, "invalid", "part 4 has gone"));
    expect(await session.confirm("sum")).toEqual({ kind: "refused", why: "part 4 has gone" });
  });
});

describe("a lease that had to be claimed again", () => {
  it("goes on with the same draft", async () => {
    const { session } = await tab();
    session.keeper.onReclaimed({ ...session.keeper.lease, id: 2 });
    await settled();
    expect(session.isConfirmedElsewhere.get()).toBe(false);
  });

  it("tells if the draft was confirmed on another computer", async () => {
    const other = { ...service.record, id: service.record.id + 1 };
    let opened = service.record;
    const { session } = await tab({ ...parts, openDraft: async () => opened });
    opened = other;
    session.keeper.onReclaimed({ ...session.keeper.lease, id: 2 });
    await settled();
    expect(session.isConfirmedElsewhere.get()).toBe(true);
  });
});
