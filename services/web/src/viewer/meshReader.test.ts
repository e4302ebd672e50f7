// @vitest-environment jsdom
import { beforeEach, describe, expect, it, vi } from "vitest";
import { onSessionEnd } from "../api/sessionEnd";
import { type MeshMessage, newMeshReader } from "./meshReader";

const WISH = { meshHash: "abc", shapeId: 3 };
let worker: EventTarget & { postMessage: () => void; terminate: () => void };

beforeEach(() => {
  worker = Object.assign(new EventTarget(), { postMessage: vi.fn(), terminate: vi.fn() });
});

const tell = (data: unknown) =>
  worker.dispatchEvent(new MessageEvent("message", { data: data as MeshMessage }));
const reader = () => newMeshReader(worker as unknown as Worker);
const read = () => reader().read(WISH);

describe("a mesh on its way", () => {
  it("shows before faces are found in it, and ends its worker once both can be done", async () => {
    const { surface, tree } = read();
    expect(worker.postMessage).toHaveBeenCalledWith(WISH);
    tell({ kind: "surface", surface: "a surface" });
    expect(await surface).toBe("a surface");
    expect(worker.postMessage).toHaveBeenCalledOnce();
    const built = tree();
    expect(worker.postMessage).toHaveBeenLastCalledWith("tree");
    expect(worker.terminate).not.toHaveBeenCalled();
    tell({ kind: "tree", tree: "a tree" });
    expect(await built).toBe("a tree");
    await vi.waitFor(() => expect(worker.terminate).toHaveBeenCalled());
  });

  it("that cannot be had says why", async () => {
    const { surface } = read();
    tell({ kind: "failed", why: "no such mesh", status: 404 });
    await expect(surface).rejects.toThrow("no such mesh");
    await vi.waitFor(() => expect(worker.terminate).toHaveBeenCalled());
  });

  it("says so where the session is over", async () => {
    const ended = vi.fn();
    const stop = onSessionEnd(ended);
    const { surface } = read();
    tell({ kind: "failed", why: "not logged in", status: 401 });
    await expect(surface).rejects.toThrow("not logged in");
    expect(ended).toHaveBeenCalled();
    stop();
  });

  it("says so where its worker breaks", async () => {
    const { surface } = read();
    worker.dispatchEvent(new ErrorEvent("error", { message: "out of memory" }));
    await expect(surface).rejects.toThrow("out of memory");
  });

  it("says so where its worker could not be loaded before it was known which mesh is wanted", async () => {
    const early = reader();
    worker.dispatchEvent(new Event("error"));
    await expect(early.read(WISH).surface).rejects.toThrow("Load the page again");
    expect(worker.terminate).toHaveBeenCalled();
  });
});
