/** Tools whose result replaces the labels in hand, as one step: refinements and labels to start from. */
import { useCallback, useEffect, useRef, useState } from "react";
import { useToast } from "../../../components";
import type { DeltaSource, Scalar } from "../../../labels/operations";
import type { OpenShape } from "../shape/openShape";
import {
  fetchLabels,
  refineBoundaries,
  refineWithModel,
  runsInOrder,
  type Segmentation,
} from "../shape/shapeRequests";

export type RefinementName = "boundaries" | "model" | "start";

interface Solved {
  readonly source: DeltaSource;
  readonly parameters: Readonly<Record<string, Scalar>>;
  readonly labels: Uint16Array;
}

export interface Refinement {
  /** Which one is under way. */
  readonly running: RefinementName | null;
  boundaries(omega: number): void;
  model(): void;
  startFrom(segmentation: Segmentation): void;
  startAsOpened(): void;
}

const ROUNDED = 1e6;

export function useRefinement(open: OpenShape | null): Refinement {
  const [running, setRunning] = useState<RefinementName | null>(null);
  const request = useRef<AbortController | null>(null);
  const showToast = useToast();

  // another shape: whatever runs is of no use any more
  // biome-ignore lint/correctness/useExhaustiveDependencies: it is the change of shape that calls the tool off
  useEffect(() => () => request.current?.abort(), [open]);

  const run = useCallback(
    async (name: RefinementName, solve: (shape: OpenShape, signal: AbortSignal) => Promise<Solved>) => {
      if (open === null || !open.canEdit) return;
      request.current?.abort();
      const own = new AbortController();
      request.current = own;
      setRunning(name);
      const madeAt = open.version.get();
      try {
        const { source, parameters, labels } = await solve(open, own.signal);
        if (own.signal.aborted) return;
        const fits = await open.replaceLabels(source, parameters, labels, madeAt);
        if (!fits)
          showToast({ message: "The labels changed meanwhile, so the result was dropped. Press again." });
        else if (open.version.get() === madeAt) showToast({ message: "Nothing changed." });
      } catch (error) {
        if (own.signal.aborted) return;
        showToast({ message: error instanceof Error ? error.message : String(error), tone: "bad" });
      } finally {
        if (request.current === own) {
          request.current = null;
          setRunning(null);
        }
      }
    },
    [open, showToast],
  );

  return {
    running,
    boundaries: (omega) => void run("boundaries", (shape, signal) => boundariesOf(shape, omega, signal)),
    model: () =>
      void run("model", async ({ draft }, signal) => {
        const labels = await refineWithModel(draft.draft.shape_id, signal);
        return { source: "model_refinement", parameters: {}, labels };
      }),
    startFrom: (from) =>
      void run("start", async ({ draft }) => {
        const labels = await fetchLabels(draft.draft.shape_id, from);
        return { source: "start_from", parameters: { from }, labels };
      }),
    startAsOpened: () =>
      void run("start", async ({ opened }) => ({
        source: "start_from",
        parameters: { from: "last draft" },
        labels: opened,
      })),
  };
}

async function boundariesOf(shape: OpenShape, omega: number, signal: AbortSignal): Promise<Solved> {
  const wish = {
    runs: runsInOrder(shape.labels),
    anchor_runs: shape.anchor === null ? null : runsInOrder(shape.anchor),
    omega: Math.round(omega * ROUNDED) / ROUNDED,
  };
  const labels = await refineBoundaries(shape.draft.draft.shape_id, wish, signal);
  return {
    source: "boundary_refinement",
    parameters: { omega: wish.omega, again: shape.anchor !== null },
    labels,
  };
}
