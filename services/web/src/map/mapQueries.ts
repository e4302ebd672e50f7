/** What the map asks the service. */
import { keepPreviousData, queryOptions } from "@tanstack/react-query";
import { api, body, type Schemas } from "../api/client";
import { type MapPoints, type PointState, pointsOf } from "./mapPoints";

type Page = Schemas["EmbeddingPage"];

const PAGE_POINTS = 20_000;

/** Which embedding the collection has: all points are read again only when it is another one. */
export const embeddingQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["embedding", collectionId],
    queryFn: async ({ signal }) => (await readPage(collectionId, 0, 1, signal)).embedding,
  });

/** The points of an embedding, as they are read: where shapes stand follows events while it is on screen. */
export const mapQuery = (collectionId: number, embedding: string) =>
  queryOptions({
    queryKey: ["map", collectionId, embedding],
    queryFn: ({ signal, client }) =>
      readMap(collectionId, signal, (share) =>
        client.setQueryData(mapProgressQuery(collectionId).queryKey, Math.min(1, share)),
      ),
    placeholderData: keepPreviousData,
    structuralSharing: false,
    staleTime: Number.POSITIVE_INFINITY,
  });

/** How much of the map has been read, in [0, 1], while it is. */
export const mapProgressQuery = (collectionId: number) =>
  queryOptions({
    queryKey: ["map progress", collectionId],
    queryFn: () => 0,
    staleTime: Number.POSITIVE_INFINITY,
  });

/** Where shapes stand, by id; those that are gone are left out. */
export async function readStates(
  collectionId: number,
  shapeIds: readonly number[],
): Promise<Map<number, PointState>> {
  const params = { path: { collection_id: collectionId }, query: { id: [...shapeIds] } };
  const found = await body(api.GET("/api/v1/collections/{collection_id}/shapes/rows", { params }));
  return new Map(found.items.map((row) => [row.id, row.state]));
}

async function readMap(
  collectionId: number,
  signal: AbortSignal,
  onProgress: (share: number) => void,
): Promise<MapPoints> {
  const pages: Page[] = [];
  let after: number | null = 0;
  while (after !== null) {
    const page: Page = await readPage(collectionId, after, PAGE_POINTS, signal);
    const isOther = pages[0] !== undefined && pages[0].embedding !== page.embedding;
    if (isOther)
      pages.length = 0; // the map was made anew meanwhile
    else pages.push(page);
    onProgress((pages.length * PAGE_POINTS) / Math.max(1, page.n_shapes));
    after = isOther ? 0 : page.next === null ? null : Number(page.next);
  }
  return pointsOf(pages);
}

function readPage(collectionId: number, after: number, limit: number, signal: AbortSignal): Promise<Page> {
  const params = { path: { collection_id: collectionId }, query: { after, limit } };
  return body(api.GET("/api/v1/collections/{collection_id}/embedding", { params, signal }));
}
