// @vitest-environment jsdom
import { cleanup, renderHook, waitFor } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { ShapeModel } from "../../../viewer/shapeModel";
import { fetchLabels, fetchUncertainty } from "../shape/shapeRequests";
import type { Shown } from "./shown";
import { useComparison } from "./useComparison";

vi.mock("../shape/shapeRequests", () => ({ fetchLabels: vi.fn(), fetchUncertainty: vi.fn() }));

const N_FACES = 2;
const draft = fakeDraft();
let made: FakeModel[];

interface FakeModel {
  readonly setLabels: () => void;
  readonly setHeat: () => void;
  readonly dispose: () => void;
}

function fakeDraft(): ShapeModel {
  const alike = () => {
    const model = { setLabels: vi.fn(), setHeat: vi.fn(), dispose: vi.fn() };
    made.push(model);
    return model;
  };
  return { mesh: { nFaces: N_FACES }, alike } as unknown as ShapeModel;
}

function compare(shown: Shown, missing: string | null = null) {
  return renderHook((now: Shown) => useComparison(3, draft, now, missing), { initialProps: shown });
}

beforeEach(() => {
  made = [];
  vi.mocked(fetchLabels).mockReset().mockResolvedValue(new Uint16Array(N_FACES));
  vi.mocked(fetchUncertainty).mockReset().mockResolvedValue(new Float32Array(N_FACES));
});
afterEach(cleanup);

it("shows labels on a model of their own, and gives it up with the view", async () => {
  const { result, unmount } = compare("predicted");
  expect(result.current).toEqual({ model: null, why: null });
  await waitFor(() => expect(result.current.model).toBe(made[0]));
  expect(made[0]?.setLabels).toHaveBeenCalled();
  unmount();
  expect(made[0]?.dispose).toHaveBeenCalledOnce();
});

it("shows how unsure the model is as heat", async () => {
  const { result } = compare("uncertainty");
  await waitFor(() => expect(result.current.model).toBe(made[0]));
  expect(made[0]?.setHeat).toHaveBeenCalled();
});

it("shows nothing that was given up to who comes back to it", async () => {
  const { result, rerender } = compare("predicted");
  await waitFor(() => expect(result.current.model).toBe(made[0]));
  rerender("draft");
  expect(made[0]?.dispose).toHaveBeenCalledOnce();
  rerender("predicted");
  expect(result.current.model).toBeNull();
  await waitFor(() => expect(result.current.model).toBe(made[1]));
});

it("gives up what comes too late", async () => {
  const { result, rerender } = compare("predicted");
  rerender("draft");
  await waitFor(() => expect(made[0]?.dispose).toHaveBeenCalledOnce());
  expect(result.current.model).toBeNull();
});

it("says why there is nothing to show, and asks for nothing that is known to be missing", async () => {
  vi.mocked(fetchLabels).mockResolvedValue(new Uint16Array(N_FACES + 1));
  const { result } = compare("refined");
  await waitFor(() => expect(result.current.why).toContain("another version of the surface"));
  expect(compare("confirmed", "Nobody has.").result.current.why).toBe("Nobody has.");
  expect(fetchLabels).toHaveBeenCalledOnce();
});
