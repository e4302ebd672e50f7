/** The service over HTTP. */
import { api, body, type Schemas } from "../api/client";
import type { StrokeJson } from "../labels/strokes";
import type { DraftTransport } from "./transport";

const PAGE = 5_000;
/** Many strokes take long to fold. */
const CONFIRMED_MS = 90_000;

export const httpTransport: DraftTransport = {
  append: (draftId, expectedSequence, strokes, signal) =>
    body(
      api.POST("/api/v1/drafts/{draft_id}/strokes", {
        params: { path: { draft_id: draftId } },
        body: {
          expected_sequence: expectedSequence,
          strokes: strokes as unknown as Schemas["Strokes"]["strokes"],
        },
        signal,
      }),
    ),
  draft: (draftId, signal) =>
    body(api.GET("/api/v1/drafts/{draft_id}", { params: { path: { draft_id: draftId } }, signal })),
  async strokes(draftId, after, signal) {
    const found: StrokeJson[] = [];
    for (let next: number | null = after; next !== null; ) {
      const page: Schemas["StrokesOut"] = await body(
        api.GET("/api/v1/drafts/{draft_id}/strokes", {
          params: { path: { draft_id: draftId }, query: { after: next, limit: PAGE } },
          signal,
        }),
      );
      found.push(...page.items.map((item) => item.payload as unknown as StrokeJson));
      next = page.next;
    }
    return found;
  },
  async confirm(draftId, nStrokes, labelsSha256) {
    await api.POST("/api/v1/drafts/{draft_id}/confirm", {
      params: { path: { draft_id: draftId }, header: { "if-match": `"${nStrokes}"` } },
      body: { labels_sha256: labelsSha256 },
      signal: AbortSignal.timeout(CONFIRMED_MS),
    });
  },
  async acknowledge(draftId, revisionId) {
    await api.POST("/api/v1/drafts/{draft_id}/acknowledge", {
      params: { path: { draft_id: draftId } },
      body: { revision_id: revisionId },
    });
  },
};
