/** What the table asks the service to do with shapes. */
import { api, body, type Schemas } from "../../../api/client";
import type { Outcome, Refusal } from "./outcome";

const ofCollection = (collectionId: number) => ({ path: { collection_id: collectionId } });
const ofShape = (shapeId: number) => ({ path: { shape_id: shapeId } });

/** Keeps shapes that wait for one person; null lets anybody have them. */
export function assign(collectionId: number, shapeIds: readonly number[], personId: number | null) {
  return body(
    api.POST("/api/v1/collections/{collection_id}/queue/assign", {
      params: ofCollection(collectionId),
      body: { shape_ids: [...shapeIds], person_id: personId },
    }),
  );
}

/** Sends the newest labels of shapes back, each by itself. */
export async function sendBack(
  collectionId: number,
  shapeIds: readonly number[],
  note: string,
  forAuthor: boolean,
): Promise<Outcome> {
  const said = await body(
    api.POST("/api/v1/collections/{collection_id}/reject", {
      params: ofCollection(collectionId),
      body: { shape_ids: [...shapeIds], note, for_author: forAuthor },
    }),
  );
  return { done: said.rejected, refused: said.refused.map(refusalOf) };
}

/** Makes a model's labels those of shapes that wait; `recheck` of them are labelled unknowing instead. */
export async function accept(
  collectionId: number,
  shapeIds: readonly number[],
  segmentation: "predicted" | "refined",
  recheck: number,
): Promise<Outcome & { readonly rechecks: number }> {
  const said = await body(
    api.POST("/api/v1/collections/{collection_id}/accept", {
      params: ofCollection(collectionId),
      body: { shape_ids: [...shapeIds], segmentation, recheck },
    }),
  );
  return { done: said.accepted, refused: said.refused.map(refusalOf), rechecks: said.rechecks };
}

/** Has shapes handed out before all others; `spread`: only so many, as far apart on the map as can be. */
export async function putFirst(
  collectionId: number,
  shapeIds: readonly number[],
  spread: number | null = null,
): Promise<readonly number[]> {
  const said = await body(
    api.POST("/api/v1/collections/{collection_id}/queue/select", {
      params: ofCollection(collectionId),
      body: { shape_ids: [...shapeIds], k: spread },
    }),
  );
  return said.shape_ids;
}

/** Puts a shape first in the queue for another round. */
export function putBack(shapeId: number, personId: number | null) {
  return api.POST("/api/v1/shapes/{shape_id}/reopen", {
    params: ofShape(shapeId),
    body: { for_person_id: personId },
  });
}

function refusalOf({ shape_id, why }: Schemas["RefusedOut"]): Refusal {
  return { shapeId: shape_id, why };
}
