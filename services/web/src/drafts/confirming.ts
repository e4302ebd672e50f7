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
  const head = failure.kind === "stale" ? unseenHead((error as Problem).document.state as StaleState) : null;
  if (head !== null) return { kind: "unseen-labels", revisionId: head, why: failure.why };
  // strokes from elsewhere also show as labels of another checksum
  await sender.refresh();
  const wentOn = sender.strokes.length !== nStrokes || sender.state.get().kind === "conflict";
  return { kind: wentOn ? "went-on" : "refused", why: failure.why };
}

function unseenHead(state: StaleState): number | null {
  const { head_revision: head, seen_revision: seen, base_revision: base } = state;
  return head === seen || head === base ? null : head;
}
