/** What leads ask the service about labels that wait for a second look, and decide about them. */
import { infiniteQueryOptions, queryOptions, useMutation, useQueryClient } from "@tanstack/react-query";
import { api, body, type Schemas } from "../api/client";
import { useToast } from "../components";
import { count } from "../components/numbers";

export type Review = Schemas["OpenReviewOut"];
export type Effort = Schemas["EffortOut"];
export type Disagreement = Schemas["DisagreementOut"];
/** interval : the low and the high end. */
export type AcceptBatch = Omit<Schemas["AcceptBatchOut"], "interval"> & {
  readonly interval: readonly number[] | null;
};
/** A review with the row of its shape. */
export interface ReviewedShape {
  readonly review: Review;
  readonly row: Schemas["ShapeRow"];
}

const PAGE = 50;
/** In place of an id that a page ended with. */
const NEWEST = 0;
const nextOf = ({ next }: { next?: string | null | undefined }) => (next == null ? null : Number(next));
const ofCollection = (collectionId: number) => ({ collection_id: collectionId });

/** What a reviewer decides. Labels that were sent back wait for an annotator. */
const REASONS: Review["reason"][] = ["map-back", "schema", "check", "disagreement"];

/** Labels that wait, oldest first, each with its shape. */
export const reviewsQuery = (collectionId: number) =>
  infiniteQueryOptions({
    queryKey: ["reviews", collectionId, "open"],
    initialPageParam: 0,
    queryFn: async ({ pageParam, signal }) => {
      const path = ofCollection(collectionId);
      const page = await body(
        api.GET("/api/v1/collections/{collection_id}/reviews", {
          params: { path, query: { after: pageParam, limit: PAGE, reason: REASONS } },
          signal,
        }),
      );
      return { items: await withRows(collectionId, page.items, signal), next: page.next };
    },
    getNextPageParam: nextOf,
  });

/** How many labels wait, of one reason or of all. */
export const reviewCountQuery = (collectionId: number, reason?: Review["reason"]) =>
  queryOptions({
    queryKey: ["reviews", collectionId, "count", reason ?? "all"],
    queryFn: async ({ signal }) => {
      const asked = reason === undefined ? REASONS : [reason];
      const params = { path: ofCollection(collectionId), query: { reason: asked } };
      return (await body(api.GET("/api/v1/collections/{collection_id}/reviews/count", { params, signal })))
        .n_reviews;
    },
  });

async function withRows(
  collectionId: number,
  reviews: readonly Review[],
  signal: AbortSignal,
): Promise<ReviewedShape[]> {
  if (reviews.length === 0) return [];
  const query = { id: [...new Set(reviews.map((review) => review.shape_id))] };
  const params = { path: ofCollection(collectionId), query };
  const found = await body(api.GET("/api/v1/collections/{collection_id}/shapes/rows", { params, signal }));
  const rows = new Map(found.items.map((row) => [row.id, row]));
  return reviews.flatMap((review) => {
    const row = rows.get(review.shape_id);
    return row ? [{ review, row }] : [];
  });
}

/** Shapes whose independent labels differ too much. */
export const disagreementsQuery = (collectionId: number) =>
  infiniteQueryOptions({
    queryKey: ["reviews", collectionId, "disagreements"],
    initialPageParam: 0,
    queryFn: ({ pageParam, signal }) =>
      body(
        api.GET("/api/v1/collections/{collection_id}/disagreements", {
          params: { path: ofCollection(collectionId), query: { after: pageParam, limit: PAGE } },
          signal,
        }),
      ),
    getNextPageParam: nextOf,
  });

/** What was accepted in bulk, newest first. */
export const acceptsQuery = (collectionId: number) =>
  infiniteQueryOptions({
    queryKey: ["accepts", collectionId],
    initialPageParam: NEWEST,
    queryFn: ({ pageParam, signal }) =>
      body(
        api.GET("/api/v1/collections/{collection_id}/accepts", {
          params: {
            path: ofCollection(collectionId),
            query: { limit: PAGE, ...(pageParam === NEWEST ? {} : { before: pageParam }) },
          },
          signal,
        }),
      ),
    getNextPageParam: nextOf,
  });

export type Decision =
  | { readonly what: "accept"; readonly shapeId: number; readonly reviewId: number }
  | { readonly what: "reject"; readonly shapeId: number; readonly reviewId: number; readonly note: string }
  | {
      readonly what: "choose";
      readonly shapeId: number;
      readonly reviewId: number;
      readonly answerId: number;
      readonly personName: string;
    };

function decide(decision: Decision): Promise<unknown> {
  const path = { shape_id: decision.shapeId, review_id: decision.reviewId };
  if (decision.what === "accept") {
    return api.POST("/api/v1/shapes/{shape_id}/reviews/{review_id}/accept", { params: { path } });
  }
  if (decision.what === "choose") {
    return api.POST("/api/v1/shapes/{shape_id}/reviews/{review_id}/choose", {
      params: { path },
      body: { answer_id: decision.answerId },
    });
  }
  return api.POST("/api/v1/shapes/{shape_id}/reviews/{review_id}/reject", {
    params: { path },
    body: { note: decision.note, for_author: false },
  });
}

function doneInWords(decision: Decision): string {
  if (decision.what === "choose") return `Labels of ${decision.personName} are the shape’s now`;
  return decision.what === "accept" ? "Labels accepted" : "Labels sent back";
}

/** Decides, and says so: here, as what was decided about leaves the page, and what shows it with it. */
export function useDecision(collectionId: number) {
  const client = useQueryClient();
  const showToast = useToast();
  return useMutation({
    mutationFn: decide,
    onSuccess: (_answer, decision) => showToast({ message: doneInWords(decision), tone: "good" }),
    // Also where it was refused: somebody else may have decided meanwhile.
    onSettled: () => client.invalidateQueries({ queryKey: ["reviews", collectionId] }),
  });
}

/** Accepts all labels that wait since parts have changed, and says how many those were. */
export function useAcceptChanged(collectionId: number) {
  const client = useQueryClient();
  const showToast = useToast();
  return useMutation({
    mutationFn: () =>
      body(
        api.POST("/api/v1/collections/{collection_id}/reviews/accept", {
          params: { path: ofCollection(collectionId) },
          body: { reason: "schema" },
        }),
      ),
    onSuccess: ({ n_accepted }) =>
      showToast({ message: `Labels of ${count(n_accepted, "shape")} accepted`, tone: "good" }),
    onSettled: () => client.invalidateQueries({ queryKey: ["reviews", collectionId] }),
  });
}
