// @vitest-environment jsdom
import { act, cleanup, renderHook, waitFor } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { OpenShape } from "../shape/openShape";
import { cutPatches } from "../shape/shapeRequests";
import { usePatches } from "./usePatches";

vi.mock("../shape/shapeRequests", () => ({ cutPatches: vi.fn() }));

const CUT = Uint32Array.of(0, 1);

interface FakeShape {
  readonly model: {
    readonly mesh: { readonly nFaces: number };
    readonly setPatches: ReturnType<typeof vi.fn>;
  };
}

/** A shape of two faces, as others are. */
function fakeShape(shapeId: number): OpenShape & FakeShape {
  const model = { mesh: { nFaces: 2 }, setPatches: vi.fn() };
  return { model, draft: { draft: { shape_id: shapeId } } } as unknown as OpenShape & FakeShape;
}

function cutting(open: OpenShape, nPatches = 2) {
  return renderHook((props) => usePatches(props.open, true, props.nPatches, "k_means"), {
    initialProps: { open, nPatches },
  });
}

beforeEach(() => {
  vi.mocked(cutPatches).mockReset().mockResolvedValue(CUT);
});
afterEach(cleanup);

it("shows the patches of a shape on it, and takes them away with the tool", async () => {
  const shape = fakeShape(3);
  const { result, unmount } = cutting(shape);
  expect(result.current).toMatchObject({ map: null, isCutting: true });
  await waitFor(() => expect(result.current).toMatchObject({ isCutting: false, map: { nPatches: 2 } }));
  expect(shape.model.setPatches).toHaveBeenLastCalledWith(CUT);
  unmount();
  expect(shape.model.setPatches).toHaveBeenLastCalledWith(null);
});

it("keeps them while their number changes", async () => {
  const shape = fakeShape(3);
  const { result, rerender } = cutting(shape);
  await waitFor(() => expect(result.current.isCutting).toBe(false));
  rerender({ open: shape, nPatches: 5 });
  expect(result.current).toMatchObject({ map: { nPatches: 2 }, isCutting: true });
});

it("gives them to no other shape, though it has as many faces", async () => {
  const [shape, another] = [fakeShape(3), fakeShape(4)];
  const { result, rerender } = cutting(shape);
  await waitFor(() => expect(result.current.isCutting).toBe(false));
  vi.mocked(cutPatches).mockReturnValue(new Promise(() => undefined));
  rerender({ open: another, nPatches: 2 });
  expect(result.current).toMatchObject({ map: null, isCutting: true });
  expect(another.model.setPatches).not.toHaveBeenCalledWith(CUT);
});

it("forgets those that come after their shape has gone", async () => {
  const [shape, another] = [fakeShape(3), fakeShape(4)];
  let come = (_patchOf: Uint32Array): void => undefined;
  vi.mocked(cutPatches).mockReturnValue(
    new Promise((resolve) => {
      come = resolve;
    }),
  );
  const { result, rerender } = cutting(shape);
  await waitFor(() => expect(cutPatches).toHaveBeenCalledOnce());
  rerender({ open: another, nPatches: 2 });
  await act(async () => come(CUT));
  expect(result.current).toMatchObject({ map: null, isCutting: true });
});
