import "fake-indexeddb/auto";
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { SessionParts } from "../../../drafts/draftSession";
import { IndexedDbOutbox } from "../../../drafts/indexedDbOutbox";
import { type Lease, leaseApi } from "../../../drafts/leaseApi";
import { FakeService, fakeBrowser, HandClock, settled, stroke } from "../../../drafts/testing";
import { SurfaceMesh } from "../../../geometry/surfaceMesh";
import type { ComingMesh } from "../../../viewer/meshReader";
import { fetchDraftBase, fetchFacts, fetchLabels, fetchReworkNote } from "../shape/shapeRequests";
import { HeldShape } from "./heldShape";

const shown: number[][] = [];

vi.mock("../shape/shapeRequests", () => ({
  fetchDraftBase: vi.fn(),
  fetchFacts: vi.fn(),
  fetchLabels: vi.fn(),
  fetchReworkNote: vi.fn(),
}));
vi.mock("../../../viewer/onScreen", () => ({ onScreen: async () => {} }));
vi.mock("../../../viewer/searchTree", () => ({ readTree: () => null }));
vi.mock("../../../viewer/preparedMesh", () => ({ meshOf: (mesh: SurfaceMesh) => ({ mesh }) }));
vi.mock("../../../viewer/shapeModel", () => ({
  ShapeModel: class {
    readonly mesh: SurfaceMesh;
    readonly drawn = Promise.resolve();
    constructor(prepared: { mesh: SurfaceMesh }) {
      this.mesh = prepared.mesh;
    }
    setLabels(labels: Uint16Array): void {
      shown.push([...labels]);
    }
    recolour(): void {}
    pickWith(): void {}
    dispose(): void {}
  },
}));

const corners = Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1);
const mesh = new SurfaceMesh(corners, Uint32Array.of(0, 1, 2, 0, 2, 3), "abc");
const surface: ComingMesh = { surface: Promise.resolve(mesh as never), tree: async () => null as never };
const opening = { partIds: [1, 2], start: "predicted" as const };
const FACTS = { state: "ready" as const, nFaces: 2, headRevision: null, headAt: null };

let database = 0;
let service: FakeService;
let parts: SessionParts;

beforeEach(() => {
  shown.length = 0;
  service = new FakeService();
  parts = {
    transport: service,
    outbox: new IndexedDbOutbox(`held ${database++}`),
    clock: new HandClock(),
    tabs: fakeBrowser(),
    openDraft: vi.fn(async () => service.record),
  };
  vi.mocked(fetchFacts).mockResolvedValue(FACTS);
  vi.mocked(fetchReworkNote).mockResolvedValue(null);
  vi.mocked(fetchLabels).mockResolvedValue(Uint16Array.of(1, 2));
  vi.spyOn(leaseApi, "renew").mockImplementation(async () => renewed(false));
});

function renewed(is_prefetched: boolean) {
  const lease = { id: 1, shape_id: 3, collection_id: 1, mesh_hash: "abc", model_version: 1, is_prefetched };
  return { lease: { ...lease, expires_at: "2026-01-01T00:05:00Z" } as Lease, at: Date.parse("2026-01-01") };
}

const held = (isPrefetched = false) => new HeldShape(parts, renewed(isPrefetched), false, () => surface);

describe("a shape that was loaded ahead", () => {
  it("shows the labels that it will start from before its draft is open", async () => {
    const shape = held(true);
    shape.load(opening, 0);
    await settled();
    expect(shape.state.get().step).toBe("labels");
    expect(shown).toEqual([[1, 2]]);
    expect(parts.openDraft).not.toHaveBeenCalled();
  });

  it("that came back with a reviewer's note goes on from its own labels instead", async () => {
    vi.mocked(fetchReworkNote).mockResolvedValue("look again");
    const shape = held(true);
    shape.load(opening, 0);
    await settled();
    expect(shown).toEqual([]);
  });
});

describe("labels to start from", () => {
  it("are the first stroke, without parts that the collection no longer has", async () => {
    vi.mocked(fetchLabels).mockResolvedValue(Uint16Array.of(1, 9));
    const shape = held();
    await shape.begin(opening);
    await settled();
    expect(shape.open?.labels).toEqual(Uint16Array.of(1, 0));
    expect(shown.at(-1)).toEqual([1, 0]);
    expect(service.log).toMatchObject([{ kind: "delta", source: "start_from" }]);
  });

  it("leave a draft alone that has strokes", async () => {
    service.log = [stroke(0)];
    const shape = held();
    await shape.begin(opening);
    expect(shape.open?.labels).toEqual(Uint16Array.of(1, 0));
  });

  it("that do not fit keep nobody from the shape, and are told of", async () => {
    vi.mocked(fetchLabels).mockResolvedValue(Uint16Array.of(1, 2, 2));
    const shape = held();
    await shape.begin(opening);
    expect(shape.open?.labels).toEqual(Uint16Array.of(0, 0));
    expect(shape.startTrouble.get()).toContain("2 and 3 faces");
  });
});

describe("a shape that could not be opened", () => {
  it("is edited once it is opened after all, since nothing holds on to it", async () => {
    parts = { ...parts, openDraft: async () => ({ ...service.record, base_revision: 5 }) };
    vi.mocked(fetchDraftBase).mockRejectedValueOnce(new Error("cut")).mockResolvedValue(Uint16Array.of(2, 2));
    const shape = held();
    await shape.begin(opening);
    expect(shape.state.get()).toEqual({ step: "failed", why: "cut" });
    await shape.retry(opening);
    expect(shape.open?.canEdit).toBe(true);
  });

  it("since nothing was known of it opens once that can be read", async () => {
    vi.mocked(fetchFacts).mockRejectedValueOnce(new Error("cut"));
    const shape = held();
    await shape.begin(opening);
    expect(shape.state.get()).toEqual({ step: "failed", why: "cut" });
    await shape.retry(opening);
    expect(shape.open?.canEdit).toBe(true);
  });
});
