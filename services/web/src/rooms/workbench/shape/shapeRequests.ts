/** What the workbench asks the service about one shape: facts, labels to start from, and tools. */
import { queryOptions } from "@tanstack/react-query";
import { api, body, fetchArrays, type Schemas } from "../../../api/client";
import { arrayOf } from "../../../api/safetensors";
import type { PatchMethod } from "../tools/toolSettings";

export type Segmentation = "predicted" | "refined" | "confirmed";
export type LabelRun = [label: number, nFaces: number];

const JSON_BODY = { "Content-Type": "application/json" };

export interface ShapeFacts {
  readonly state: Schemas["ShapeOut"]["state"];
  readonly nFaces: number | null;
  /** The newest labels, if they are of the mesh that the shape has now. */
  readonly headRevision: number | null;
  readonly headAt: string | null;
}

function fetchShape(shapeId: number) {
  return body(api.GET("/api/v1/shapes/{shape_id}", { params: { path: { shape_id: shapeId } } }));
}

export const shapeQuery = (shapeId: number) =>
  queryOptions({ queryKey: ["shape", shapeId, "workbench"], queryFn: () => fetchShape(shapeId) });

export async function fetchFacts(shapeId: number): Promise<ShapeFacts> {
  const { state, mesh, head } = await fetchShape(shapeId);
  const fitting = head !== null && head.mesh_hash === mesh?.mesh_hash ? head : null;
  return {
    state,
    nFaces: mesh?.n_faces ?? null,
    headRevision: fitting?.id ?? null,
    headAt: fitting?.created_at ?? null,
  };
}

/** Why a shape came back: what the reviewer wrote; null if it did not. */
export async function fetchReworkNote(shapeId: number): Promise<string | null> {
  const { items } = await body(
    api.GET("/api/v1/shapes/{shape_id}/reviews", { params: { path: { shape_id: shapeId } } }),
  );
  const open = items.find((review) => review.reason === "rework" && review.resolved_at === null);
  const note = open?.detail.note;
  return open === undefined ? null : typeof note === "string" ? note : "";
}

export async function fetchLabels(shapeId: number, segmentation: Segmentation): Promise<Uint16Array> {
  return labelsIn(await fetchArrays(`/shapes/${shapeId}/labels?segmentation=${segmentation}`));
}

export async function fetchRevision(shapeId: number, revisionId: number): Promise<Uint16Array> {
  return labelsIn(await fetchArrays(`/shapes/${shapeId}/labels?revision=${revisionId}`));
}

/** The labels that strokes of a revision follow on; null for none, which is all unlabelled. */
export async function fetchBase(shapeId: number, baseRevision: number | null): Promise<Uint16Array | null> {
  return baseRevision === null ? null : fetchRevision(shapeId, baseRevision);
}

/** How unsure the newest model is of each face, 0 to 1. */
export async function fetchUncertainty(shapeId: number): Promise<Float32Array> {
  return arrayOf(await fetchArrays(`/shapes/${shapeId}/uncertainty`), "uncertainty", Float32Array);
}

/** The labels that a draft starts from. */
export async function fetchDraftBase(draftId: number): Promise<Uint16Array> {
  return arrayOf(await fetchArrays(`/drafts/${draftId}/labels`), "base", Uint16Array);
}

export async function cutPatches(
  shapeId: number,
  wish: { n_patches: number; method: PatchMethod },
  signal: AbortSignal,
): Promise<Uint32Array> {
  const file = await fetchArrays(`/shapes/${shapeId}/patches`, posted(wish, signal));
  return arrayOf(file, "labels", Uint32Array);
}

export async function refineBoundaries(
  shapeId: number,
  wish: { runs: LabelRun[]; anchor_runs: LabelRun[] | null; omega: number },
  signal: AbortSignal,
): Promise<Uint16Array> {
  return labelsIn(await fetchArrays(`/shapes/${shapeId}/refine-boundaries`, posted(wish, signal)));
}

export async function refineWithModel(shapeId: number, signal: AbortSignal): Promise<Uint16Array> {
  return labelsIn(await fetchArrays(`/shapes/${shapeId}/refine-model`, posted({}, signal)));
}

/** Labels in face order as [label, how many faces], as the tools are told them. */
export function runsInOrder(labels: Uint16Array): LabelRun[] {
  const runs: LabelRun[] = [];
  let last: LabelRun | undefined;
  for (const label of labels) {
    if (last?.[0] === label) last[1] += 1;
    else {
      last = [label, 1];
      runs.push(last);
    }
  }
  return runs;
}

function posted(wish: unknown, signal: AbortSignal): RequestInit {
  return { method: "POST", headers: JSON_BODY, body: JSON.stringify(wish), signal };
}

function labelsIn(file: Awaited<ReturnType<typeof fetchArrays>>): Uint16Array {
  return arrayOf(file, "labels", Uint16Array);
}
