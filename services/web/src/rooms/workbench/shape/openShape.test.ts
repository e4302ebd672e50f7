import "fake-indexeddb/auto";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { DraftSession } from "../../../drafts/draftSession";
import { IndexedDbOutbox } from "../../../drafts/indexedDbOutbox";
import type { Lease } from "../../../drafts/leaseApi";
import { LeaseKeeper } from "../../../drafts/leaseKeeper";
import { draftIdentity, type KeptAside, type SetAside } from "../../../drafts/outbox";
import { FakeService, fakeBrowser, HandClock, problem, settled, stroke } from "../../../drafts/testing";
import { SurfaceMesh } from "../../../geometry/surfaceMesh";
import { makeDelta } from "../../../labels/deltaCodec";
import type { Operation } from "../../../labels/operations";
import { newStroke, type StrokeJson } from "../../../labels/strokes";
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
    await shape.putOnTop(aside as KeptAside, null);
    await settled();
    expect([...shape.labels]).toEqual([1, 0, 3, 3, 0, 0]);
  });
});

describe("strokes that were set aside", () => {
  const at = "2026-01-01T00:00:00Z";
  const base = Uint16Array.of(0, 0, 0, 0, 2, 2);

  function aside(before: readonly StrokeJson[], ...strokes: readonly StrokeJson[]): SetAside {
    return { draft: draftIdentity(service.record), before, at: 0, reason: "closed", strokes };
  }

  const segmented = (sequence: number, seed: number, label: number): StrokeJson => {
    const place = { sequence, base_revision: 5, author_id: 2 };
    return { v: 1, kind: "segment_wide", seed, label, id: `segmented ${sequence}`, at, ...place };
  };

  it("give a later draft the faces that they changed in their own", async () => {
    const shape = await opened();
    shape.perform(assign(0, 4, 1));
    await shape.putOnTop(aside([segmented(0, 0, 3)], segmented(1, 4, 1), segmented(2, 0, 2)), base);
    await settled();
    expect([...shape.labels]).toEqual([2, 2, 2, 2, 1, 1]);
    expect(service.log).toHaveLength(3);
  });

  it("leave faces without a label whose part has gone", async () => {
    const shape = await opened([1]);
    shape.perform(assign(0, 4, 1));
    await shape.putOnTop(aside([], stroke(0, "gone", 9), stroke(1, "here", 1)), null);
    expect([...shape.labels]).toEqual([0, 1, 1, 1, 0, 0]);
  });

  it("are not put on labels that changed meanwhile, nor where nothing may be changed", async () => {
    const shape = await opened();
    const putting = shape.putOnTop(aside([], stroke(0)), null);
    shape.perform(assign(2, 2, 3));
    await expect(putting).rejects.toThrow("changed meanwhile");
    shape.isConfirming.set(true);
    await expect(shape.putOnTop(aside([], stroke(0)), null)).rejects.toThrow("nothing was put on top");
    expect([...shape.labels]).toEqual([0, 0, 3, 3, 0, 0]);
  });
});

describe("labels of a part that the collection no longer has", () => {
  it("are given to no face, and stay where they were", async () => {
    const shape = await opened(null);
    shape.perform(assign(0, 2, 9));
    shape.setParts([1, 2]);
    expect(await shape.replaceLabels("model_refinement", {}, refined(9, 1, 9, 2, 0, 0))).toBe(true);
    expect([...shape.labels]).toEqual([9, 1, 0, 2, 0, 0]);
  });
});

describe("confirming", () => {
  it("takes no stroke until it is known that it was refused", async () => {
    const shape = await opened();
    const confirming = shape.confirm();
    expect(shape.perform(assign(0, 2, 1))).toBeNull();
    expect((await confirming).kind).toBe("confirmed");
    expect(shape.canEdit).toBe(false);

    const other = await opened();
    service.confirm = () => Promise.reject(problem(422, "invalid", "no"));
    expect((await other.confirm()).kind).toBe("refused");
    expect(other.canEdit).toBe(true);
  });

  it("elsewhere ends drawing here", async () => {
    const shape = await opened();
    shape.draft.isConfirmedElsewhere.set(true);
    expect(shape.canEdit).toBe(false);
  });
});

describe("strokes of another tab", () => {
  it("are done in their order, though one takes longer to be read than the next", async () => {
    const shape = await opened();
    const delta = await makeDelta("patches", {}, refined(0, 0, 0, 0, 0, 0), refined(1, 1, 1, 0, 0, 0));
    const place = { base_revision: null, author_id: 2 };
    const strokes = [
      newStroke(delta, { ...place, sequence: 0 }),
      newStroke({ kind: "undo" }, { ...place, sequence: 1 }),
      newStroke(assign(5, 1, 2), { ...place, sequence: 2 }),
    ];
    const apply = vi.spyOn(shape.editor, "apply");
    for (const each of strokes) {
      shape.draft.sender.follow(each);
      shape.draft.listener?.onFollowed(each);
    }
    expect(shape.canEdit).toBe(false);
    await new Promise<void>((resolve) => shape.isBehind.subscribe(resolve));
    await settled();
    expect(apply).toHaveBeenCalledTimes(3);
    expect([...shape.labels]).toEqual([0, 0, 0, 0, 0, 2]);
    expect(shape.canEdit).toBe(true);
  });

  it("are waited for from the moment that the log has them", async () => {
    const shape = await opened();
    shape.draft.sender.follow(stroke(0, "theirs"));
    expect(shape.perform(assign(2, 2, 3))).toBeNull();
  });

  it("are done once, though they come while the labels are made anew", async () => {
    const shape = await opened();
    service.log = [stroke(0, "theirs")];
    await shape.draft.sender.refresh();
    const next = stroke(1, "next");
    shape.draft.sender.follow(next);
    shape.draft.listener?.onFollowed(next);
    await settled();
    expect([...shape.labels]).toEqual([1, 1, 0, 0, 0, 0]);
    shape.undo();
    expect([...shape.labels]).toEqual([1, 0, 0, 0, 0, 0]);
  });
});
