/** Confirming the shape in hand, and what may stand in its way. */
import { useRef, useState } from "react";
import { useToast } from "../../../components";
import type { Desk } from "./desk";
import type { HeldShape } from "./heldShape";

export interface Confirming {
  readonly isBusy: boolean;
  /** Labels that somebody else confirmed meanwhile; null if none. */
  readonly unseenRevision: number | null;
  /** The shape before this one. */
  readonly lastConfirmed: string | null;
  confirm(): Promise<void>;
  confirmOver(): Promise<void>;
}

export function useConfirming(desk: Desk, held: HeldShape): Confirming {
  const showToast = useToast();
  const [unseen, setUnseen] = useState<{ held: HeldShape; revisionId: number } | null>(null);
  const [lastConfirmed, setLastConfirmed] = useState<string | null>(null);
  const [busyWith, setBusyWith] = useState<HeldShape | null>(null);
  const isAsking = useRef(false);

  const confirm = async () => {
    if (isAsking.current || held.open === null || !held.open.canEdit) return;
    isAsking.current = true;
    setBusyWith(held);
    try {
      const outcome = await desk.confirm(held);
      if (outcome.kind === "confirmed") setLastConfirmed(held.lease.source_key);
      else if (outcome.kind === "unseen-labels") setUnseen({ held, revisionId: outcome.revisionId });
      else showToast({ message: wordsOf(outcome), tone: "bad" });
    } finally {
      isAsking.current = false;
      setBusyWith(null);
    }
  };
  const confirmOver = async () => {
    if (unseen === null || held.open === null) return;
    try {
      await held.open.draft.acknowledge(unseen.revisionId);
      setUnseen(null);
    } catch (error) {
      showToast({ message: error instanceof Error ? error.message : String(error), tone: "bad" });
      return;
    }
    await confirm();
  };
  return {
    isBusy: busyWith === held,
    lastConfirmed,
    unseenRevision: unseen?.held === held ? unseen.revisionId : null,
    confirm,
    confirmOver,
  };
}

function wordsOf(outcome: { readonly kind: string; readonly why?: string }): string {
  if (outcome.kind === "unsaved")
    return "Not confirmed: some strokes are not saved yet. Press Enter again once they are.";
  if (outcome.kind === "went-on")
    return "Not confirmed: strokes came in from elsewhere. Look at them, then confirm.";
  return `Not confirmed: ${outcome.why ?? "try again"}`;
}
