import { useObservableOr } from "../../../drafts/useObservable";
import type { OpenShape } from "./openShape";

/** Whether labels may be changed now, followed through conflicts and other tabs. */
export function useCanEdit(open: OpenShape | null): boolean {
  useObservableOr(open?.draft.sender.state, null);
  useObservableOr(open?.draft.right.role, null);
  return open?.canEdit ?? false;
}
