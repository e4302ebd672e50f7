import "fake-indexeddb/auto";
import { beforeEach, describe, expect, it } from "vitest";
import { DraftSession } from "../../../drafts/draftSession";
import { IndexedDbOutbox } from "../../../drafts/indexedDbOutbox";
import type { Lease } from "../../../drafts/leaseApi";
import { LeaseKeeper } from "../../../drafts/leaseKeeper";
import { FakeService, fakeBrowser, HandClock, settled, stroke } from "../../../drafts/testing";
import { SurfaceMesh } from "../../../geometry/surfaceMesh";
import type { Operation } from "../../../labels/operations";
import type { ShapeModel } from "../../../viewer/shapeModel";
import { OpenShape } from "./openShape";

const N_FACES = 6;
let database = 0;
let service: FakeService;
let shown: { labels: Uint16Array | null; nRecoloured: number };

beforeEach(() => {
  service = new FakeService();
  shown = { labels: null, nRecoloured: 0 };
});

async function opened(partIds: readonly number[] | null = [1, 2, 3]): Promise<OpenShape> {
  const corners = Float32Array.from({ length: 3 * (N_FACES + 2) }, (_, at) =>
    at % 3 === 0 ? at / 6 : (at * at) % 5,
  );
  const faces = Uint32Array.from({ length: 3 * N_FACES }, (_, at) => Math.floor(at / 3) + (at % 3));
  const model = {
    mesh: new SurfaceMesh(corners, faces, "abc"),
    setLabels: (labels: Uint16Array) => {
      shown.labels = labels;
    },
    recolour: (changed: Uint32Array) => {
      shown.nRecoloured += changed.length;
    },
  } as unknown as ShapeModel;
  const clock = new HandClock();
  const lease = { id: 1, shape_id: 3, collection_id: 1, expires_at: "2026-01-01T00:05:00Z" } as Lease;
  const renewed = { lease, at: Date.parse("2026-01-01T00:00:00Z") };
  const leases = { renew: async () => renewed, reclaim: async () => renewed };
  const outbox = new IndexedDbOutbox(`open shape ${database++}`);
  const parts = {
    transport: service,
    outbox,
    clock,
    tabs: fakeBrowser(),
    openDraft: async () => service.record,
  };
  const draft = await DraftSession.open(parts, new LeaseKeeper(leases, clock, renewed), null);
  return OpenShape.open(model, draft, null, partIds);
}

const assign = (first: number, count: number, label: number): Operation => ({
  kind: "assign",
  runs: [[first, count]],
  label,
});
const refined = (...labels: number[]) => Uint16Array.from(labels);

describe("a shape in hand", () => {
  it("records what changes labels, and shows it", async () => {
    const shape = await opened();
    shape.perform(assign(0, 2, 1));
    await settled();
    expect([...shape.labels]).toEqual([1, 1, 0, 0, 0, 0]);
    expect(service.log).toMatchObject([{ kind: "assign", sequence: 0, author_id: 2 }]);
    expect(shown.nRecoloured).toBe(2);
  });

  it("records nothing that changes no face", async () => {
    const shape = await opened();
    shape.perform(assign(0, 2, 1));
    expect(shape.perform(assign(0, 2, 1))).toBeNull();
    shape.redo();
    await settled();
    expect(service.log).toHaveLength(1);
  });

  it("takes any part until the collection's are known, then those only", async () => {
    const shape = await opened(null);
    shape.perform(assign(0, 1, 9));
    shape.setParts([1]);
    expect(() => shape.perform(assign(1, 1, 9))).toThrow("part of the collection");
    await settled();
    expect(service.log).toHaveLength(1);
  });

  it("takes back a solver's labels as one step", async () => {
    const shape = await opened();
    shape.perform(assign(0, 2, 1));
    await shape.replaceLabels("model_refinement", {}, refined(1, 1, 2, 2, 3, 3));
    shape.undo();
    await settled();
    expect([...shape.labels]).toEqual([1, 1, 0, 0, 0, 0]);
    expect(service.log.map((each) => each.kind)).toEqual(["assign", "delta", "undo"]);
  });

  it("drops a solver's labels when strokes came in between", async () => {
    const shape = await opened();
    const madeAt = shape.version.get();
    shape.perform(assign(0, 2, 1));
    expect(await shape.replaceLabels("model_refinement", {}, refined(2, 2, 2, 2, 2, 2), madeAt)).toBe(false);
    expect([...shape.labels]).toEqual([1, 1, 0, 0, 0, 0]);
  });

  it("is as it was after a reload, undo and all", async () => {
    const before = await opened();
    before.perform(assign(0, 2, 1));
    before.perform(assign(2, 2, 2));
    await settled();
    const after = await opened();
    after.undo();
    expect([...after.labels]).toEqual([1, 1, 0, 0, 0, 0]);
  });

  it("shows strokes that were made elsewhere", async () => {
    const shape = await opened();
    service.log = [stroke(0, "theirs")];
    await shape.draft.sender.refresh();
    await settled();
    expect([...shape.labels]).toEqual([1, 0, 0, 0, 0, 0]);
    expect(shown.labels).toBe(shape.labels);
  });
});

describe("labels that refining again stays near", () => {
  it("are those before the first of several refinements", async () => {
    const shape = await opened();
    shape.perform(assign(0, 2, 1));
    await shape.replaceLabels("boundary_refinement", {}, refined(1, 1, 1, 0, 0, 0));
    await shape.replaceLabels("boundary_refinement", {}, refined(1, 1, 1, 1, 0, 0));
    expect([...(shape.anchor ?? [])]).toEqual([1, 1, 0, 0, 0, 0]);
  });

  it("are those at hand again after any other stroke", async () => {
    const shape = await opened();
    shape.perform(assign(0, 2, 1));
    await shape.replaceLabels("boundary_refinement", {}, refined(1, 1, 1, 0, 0, 0));
    shape.perform(assign(5, 1, 2));
    expect(shape.anchor).toBeNull();
  });

  it("are the same after a reload", async () => {
    const before = await opened();
    before.perform(assign(0, 2, 1));
    await before.replaceLabels("boundary_refinement", {}, refined(1, 1, 1, 0, 0, 0));
    await settled();
    expect([...((await opened()).anchor ?? [])]).toEqual([1, 1, 0, 0, 0, 0]);
  });
});

describe("a conflict", () => {
  it("is settled by putting what was changed here on top of what is on record", async () => {
    const shape = await opened();
    service.log = [stroke(0, "theirs")];
    shape.perform(assign(2, 2, 3));
    await settled();
    expect(shape.canEdit).toBe(false);
    const sides = await shape.sidesOfConflict();
    expect([...(sides?.mine ?? [])]).toEqual([0, 0, 3, 3, 0, 0]);
    expect([...(sides?.theirs ?? [])]).toEqual([1, 0, 0, 0, 0, 0]);
    await shape.keepMine();
    await settled();
    expect([...shape.labels]).toEqual([1, 0, 3, 3, 0, 0]);
    expect(service.log).toHaveLength(2);
    expect(shape.canEdit).toBe(true);
  });

  it("loses nothing by taking what is on record: mine can be put on top later", async () => {
    const shape = await opened();
    service.log = [stroke(0, "theirs")];
    shape.perform(assign(2, 2, 3));
    await settled();
    await shape.draft.sender.takeTheirs();
    await settled();
    const [aside] = await shape.draft.sender.outbox.asides();
    await shape.putOnTop(aside?.first ?? 0, aside?.strokes ?? []);
    await settled();
    expect([...shape.labels]).toEqual([1, 0, 3, 3, 0, 0]);
  });
});
