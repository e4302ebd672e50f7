/** What is looked at beside a draft, on a model of its own, so that other views go on showing the draft. */
import { useEffect, useState } from "react";
import type { ShapeModel } from "../../../viewer/shapeModel";
import { fetchLabels, fetchUncertainty } from "../shape/shapeRequests";
import type { Shown } from "./shown";

export interface Comparison {
  /** Null while it is not there, and for the draft itself. */
  readonly model: ShapeModel | null;
  /** Why it will not come. */
  readonly why: string | null;
}

interface Found extends Comparison {
  readonly draft: ShapeModel;
  readonly shown: Shown;
}

const NONE: Comparison = { model: null, why: null };

/**
 * draft : the shape as its draft shows it; null while it is being loaded. missing : why it is known that there is no such
 * thing; null if there should be.
 */
export function useComparison(
  shapeId: number,
  draft: ShapeModel | null,
  shown: Shown,
  missing: string | null,
): Comparison {
  const [found, setFound] = useState<Found | null>(null);
  useEffect(() => {
    if (draft === null || shown === "draft" || missing !== null) return undefined;
    let made: ShapeModel | null = null;
    let isOver = false;
    modelOf(shapeId, draft, shown).then(
      (model) => {
        if (isOver) return model.dispose();
        made = model;
        setFound({ draft, shown, model, why: null });
      },
      (error: unknown) => {
        const why = error instanceof Error ? error.message : String(error);
        if (!isOver) setFound({ draft, shown, model: null, why });
      },
    );
    return () => {
      isOver = true;
      made?.dispose();
      setFound(null); // who comes back to it is not shown what was given up
    };
  }, [shapeId, draft, shown, missing]);
  if (missing !== null) return { model: null, why: missing };
  return found !== null && found.draft === draft && found.shown === shown ? found : NONE;
}

async function modelOf(
  shapeId: number,
  draft: ShapeModel,
  shown: Exclude<Shown, "draft">,
): Promise<ShapeModel> {
  const values = await (shown === "uncertainty" ? fetchUncertainty(shapeId) : fetchLabels(shapeId, shown));
  if (values.length !== draft.mesh.nFaces) {
    throw new Error("They are on another version of the surface, so they cannot be shown on this one.");
  }
  const model = draft.alike();
  if (values instanceof Float32Array) model.setHeat(values);
  else model.setLabels(values);
  return model;
}
