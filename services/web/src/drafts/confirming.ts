/** Confirming a draft: what may come of it. */
import type { Problem } from "../api/problem";
import type { StrokeSender } from "./strokeSender";
import { type DraftTransport, failureOf } from "./transport";

export type ConfirmOutcome =
  | { readonly kind: "confirmed" }
  /** Strokes are not on record yet, or there is a conflict about them: the save state says which. */
  | { readonly kind: "unsaved" }
  /** Somebody else's labels were confirmed meanwhile: they must be looked at first. */
  | { readonly kind: "unseen-labels"; readonly revisionId: number; readonly why: string }
  /** The draft got strokes elsewhere; they have been taken up, so that the person sees them before confirming. */
  | { readonly kind: "went-on"; readonly why: string }
  /** Not done for now: the same again. */
  | { readonly kind: "unreachable"; readonly why: string }
  | { readonly kind: "refused"; readonly why: string };

interface StaleState {
  readonly n_strokes: number;
  readonly base_revision: number | null;
  readonly seen_revision: number | null;
  readonly head_revision: number | null;
}

/** Confirms exactly the strokes and labels that the person sees. Doing it again after a lost answer is safe. */
export async function confirmDraft(
  transport: DraftTransport,
  sender: StrokeSender,
  labelsSha256: string,
): Promise<ConfirmOutcome> {
  if (!(await sender.flush())) return { kind: "unsaved" };
  const nStrokes = sender.strokes.length;
  try {
    await transport.confirm(sender.draft.draftId, nStrokes, labelsSha256);
    return { kind: "confirmed" };
  } catch (error) {
    return await outcomeOf(error, sender, nStrokes);
  }
}

async function outcomeOf(error: unknown, sender: StrokeSender, nStrokes: number): Promise<ConfirmOutcome> {
  const failure = failureOf(error);
  if (failure.kind === "passing") return { kind: "unreachable", why: failure.why };
  if (failure.kind !== "stale") return { kind: "refused", why: failure.why };
  const state = (error as Problem).document.state as StaleState;
  if (state.n_strokes !== nStrokes) {
    await sender.refresh();
    return { kind: "went-on", why: failure.why };
  }
  const { head_revision: head } = state;
  if (head !== null && head !== state.seen_revision && head !== state.base_revision) {
    return { kind: "unseen-labels", revisionId: head, why: failure.why };
  }
  return { kind: "refused", why: failure.why };
}
