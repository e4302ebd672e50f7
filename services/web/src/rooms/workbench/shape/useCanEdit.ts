import { useObservableOr } from "../../../drafts/useObservable";
import type { OpenShape } from "./openShape";

/** Whether labels may be changed now, followed through conflicts, other tabs and confirming. */
export function useCanEdit(open: OpenShape | null): boolean {
  useObservableOr(open?.draft.sender.state, null);
  useObservableOr(open?.draft.right.role, null);
  useObservableOr(open?.draft.isConfirmedElsewhere, null);
  useObservableOr(open?.isConfirming, null);
  useObservableOr(open?.isBehind, null);
  return open?.canEdit ?? false;
}
