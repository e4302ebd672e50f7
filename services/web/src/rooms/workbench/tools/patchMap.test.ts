import { expect, it } from "vitest";
import { PatchMap } from "./patchMap";

it("knows the faces of every patch, ascending", () => {
  const map = new PatchMap(Uint32Array.of(1, 0, 1, 2, 0));
  expect(map.nPatches).toBe(3);
  expect([0, 1, 2].map((patch) => [...map.facesOf(patch)])).toEqual([[1, 4], [0, 2], [3]]);
});

it("finds the patch around a face", () => {
  expect([...new PatchMap(Uint32Array.of(1, 0, 1)).around(0)]).toEqual([0, 2]);
});
