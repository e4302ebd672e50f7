/** Patches of the shape in hand while the tool is, cut anew when their number or method changes. */
import { useEffect, useState } from "react";
import type { ShapeModel } from "../../../viewer/shapeModel";
import type { OpenShape } from "../shape/openShape";
import { cutPatches } from "../shape/shapeRequests";
import { PatchMap } from "./patchMap";
import type { PatchMethod } from "./toolSettings";

export interface Patches {
  readonly map: PatchMap | null;
  readonly isCutting: boolean;
  /** Why there are none. */
  readonly why: string | null;
}

/** Patches of one shape; those of another do not fit, though it may have as many faces. */
interface Cut extends Patches {
  readonly model: ShapeModel | null;
}

const NONE: Cut = { model: null, map: null, isCutting: false, why: null };
const SETTLE_MS = 120;

export function usePatches(
  open: OpenShape | null,
  isWanted: boolean,
  nPatches: number,
  method: PatchMethod,
): Patches {
  const [cut, setCut] = useState<Cut>(NONE);
  const shapeId = open?.draft.draft.shape_id ?? null;
  const model = open?.model ?? null;
  const patches = cut.model === model ? cut : NONE;

  useEffect(() => {
    if (model === null || shapeId === null || !isWanted) {
      setCut(NONE);
      return undefined;
    }
    const request = new AbortController();
    // the last ones stay meanwhile
    setCut((last) => ({ model, map: last.model === model ? last.map : null, isCutting: true, why: null }));
    const timer = window.setTimeout(() => {
      cutPatches(shapeId, { n_patches: nPatches, method }, request.signal).then(
        (patchOf) => {
          if (request.signal.aborted) return;
          setCut({ model, map: new PatchMap(patchOf), isCutting: false, why: null });
        },
        (error: unknown) => {
          if (request.signal.aborted) return;
          setCut({
            model,
            map: null,
            isCutting: false,
            why: error instanceof Error ? error.message : String(error),
          });
        },
      );
    }, SETTLE_MS); // the slider passes many numbers on its way
    return () => {
      window.clearTimeout(timer);
      request.abort();
    };
  }, [model, shapeId, isWanted, nPatches, method]);

  useEffect(() => {
    model?.setPatches(patches.map?.patchOf ?? null);
    return () => model?.setPatches(null);
  }, [model, patches.map]);
  return patches;
}
