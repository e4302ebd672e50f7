// @vitest-environment jsdom
import { beforeEach, describe, expect, it, vi } from "vitest";
import { leaseApi } from "../../../drafts/leaseApi";
import { settled } from "../../../drafts/testing";
import type { MeshWish } from "../../../viewer/meshReader";
import { HeadStart } from "./headStart";

const LEASED = { lease: { shape_id: 3, mesh_hash: "abc", is_prefetched: false }, at: 0 };
const AHEAD = { lease: { shape_id: 4, mesh_hash: "def", is_prefetched: true }, at: 0 };
let workers: FakeWorker[];

class FakeWorker extends EventTarget {
  readonly wishes: MeshWish[] = [];
  isEnded = false;

  constructor() {
    super();
    workers.push(this);
  }

  postMessage(wish: MeshWish): void {
    this.wishes.push(wish);
  }

  terminate(): void {
    this.isEnded = true;
  }
}

beforeEach(() => {
  workers = [];
  vi.stubGlobal("Worker", FakeWorker);
  vi.restoreAllMocks();
  vi.spyOn(leaseApi, "held").mockResolvedValue([AHEAD, LEASED] as never);
  vi.spyOn(leaseApi, "named").mockResolvedValue({ leases: [LEASED], refused: [] } as never);
});

describe("a head start", () => {
  it("claims the shapes that the address names, once, and reads the mesh of the first", async () => {
    const ahead = new HeadStart(1, [3, 4]);
    await settled();
    expect(workers.map(({ wishes }) => wishes)).toEqual([[{ meshHash: "abc", shapeId: 3 }]]);
    expect(await ahead.leases.named(1, [3, 4])).toMatchObject({ leases: [LEASED] });
    expect(leaseApi.named).toHaveBeenCalledOnce();
    await ahead.leases.named(1, [3, 4]);
    expect(leaseApi.named).toHaveBeenCalledTimes(2);
  });

  it("reads the mesh of the shape in hand, not of the one loaded ahead, where none is named", async () => {
    const ahead = new HeadStart(1, []);
    await settled();
    expect(workers[0]?.wishes).toEqual([{ meshHash: "abc", shapeId: 3 }]);
    expect(await ahead.leases.held(1)).toHaveLength(2);
    expect(leaseApi.held).toHaveBeenCalledOnce();
    expect(leaseApi.named).not.toHaveBeenCalled();
  });

  it("hands over the mesh that it reads; any other has a worker of its own", async () => {
    const ahead = new HeadStart(1, [3]);
    await settled();
    ahead.mesh({ meshHash: "abc", shapeId: 3 });
    expect(workers).toHaveLength(1);
    ahead.mesh({ meshHash: "abc", shapeId: 3 });
    expect(workers).toHaveLength(2);
  });

  it("is of no use to another collection or for other shapes", async () => {
    const ahead = new HeadStart(1, [3]);
    await ahead.leases.held(2);
    await ahead.leases.named(1, [5]);
    expect(leaseApi.held).toHaveBeenLastCalledWith(2);
    expect(leaseApi.named).toHaveBeenLastCalledWith(1, [5]);
  });

  it("that failed is asked again, and its worker ends", async () => {
    vi.mocked(leaseApi.named).mockRejectedValueOnce(new Error("signed out"));
    vi.mocked(leaseApi.held).mockRejectedValueOnce(new Error("signed out"));
    const ahead = new HeadStart(1, [3]);
    await settled();
    expect(workers[0]?.isEnded).toBe(true);
    expect(await ahead.leases.held(1)).toHaveLength(2);
    expect(await ahead.leases.named(1, [3])).toMatchObject({ leases: [LEASED] });
  });
});
