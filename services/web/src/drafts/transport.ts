/** What a draft asks the service, and what may come of it. */
import { Problem } from "../api/problem";
import type { StrokeJson } from "../labels/strokes";

export interface DraftRecord {
  readonly id: number;
  readonly collection_id: number;
  readonly shape_id: number;
  readonly person_id: number;
  readonly mesh_hash: string;
  readonly base_revision: number | null;
  readonly base_sha256: string;
  readonly schema_version: number;
  readonly n_strokes: number;
  readonly created_at: string;
  readonly outcome: string | null;
}

/** Every call is aborted by its signal, and fails with `Problem` or `Unreachable`. */
export interface DraftTransport {
  append(
    draftId: number,
    expectedSequence: number,
    strokes: readonly StrokeJson[],
    signal: AbortSignal,
  ): Promise<DraftRecord>;
  draft(draftId: number, signal: AbortSignal): Promise<DraftRecord>;
  /** The whole log on record from stroke `after` + 1 on. */
  strokes(draftId: number, after: number, signal: AbortSignal): Promise<StrokeJson[]>;
  confirm(draftId: number, nStrokes: number, labelsSha256: string | null): Promise<void>;
  acknowledge(draftId: number, revisionId: number): Promise<void>;
}

export type Failure =
  /** The network, or a service that is down or busy: the same again, later. */
  | { readonly kind: "passing"; readonly why: string }
  | { readonly kind: "signed-out"; readonly why: string }
  /** The log on record is another than expected. */
  | { readonly kind: "stale"; readonly why: string }
  /** The draft takes no strokes any more. */
  | { readonly kind: "closed"; readonly why: string }
  /** The same again would fail again. */
  | { readonly kind: "refused"; readonly why: string };

const BUSY = [408, 425, 429];

/** What a failed append means. Anything unforeseen counts as passing, since giving up would lose the strokes. */
export function failureOf(error: unknown): Failure {
  const why = error instanceof Error ? error.message : String(error);
  if (!(error instanceof Problem) || error.status >= 500 || BUSY.includes(error.status)) {
    return { kind: "passing", why };
  }
  if (error.status === 401) return { kind: "signed-out", why };
  if (error.status === 409) return { kind: isStillOpen(error.document.state) ? "stale" : "closed", why };
  return { kind: "refused", why };
}

/** Whether a refusal tells the state of a draft that takes strokes: without one, or with an outcome, it takes none. */
function isStillOpen(state: unknown): boolean {
  return typeof state === "object" && state !== null && (state as { outcome?: unknown }).outcome === null;
}
