import { Check, CloudOff, Loader, TriangleAlert } from "lucide-react";
import { classes } from "../../../components";
import { count, whole } from "../../../components/numbers";
import type { SaveState } from "../../../drafts/saveState";
import { useObservable } from "../../../drafts/useObservable";
import type { OpenShape } from "../shape/openShape";
import styles from "./SaveMark.module.css";

const strokes = (n: number) => count(n, "stroke");

/** Whether what the person did is safe, in words. */
export function wordsOf(state: SaveState): string {
  switch (state.kind) {
    case "saved":
      return "Saved";
    case "saving":
      return "Saving…";
    case "offline":
      return `Offline: ${whole(state.nQueued)} queued`;
    case "signed-out":
      return `Log in to send ${strokes(state.nQueued)}`;
    case "conflict":
      return "Two versions";
    case "closed":
      return state.nQueued === 0 ? "Closed elsewhere" : `${strokes(state.nQueued)} not taken`;
    case "refused":
      return `${strokes(state.nQueued)} refused`;
  }
}

export function SaveMark({ open }: { open: OpenShape }) {
  const state = useObservable(open.draft.sender.state);
  const isKept = state.kind === "saved" || state.isKept;
  const Icon = { saved: Check, saving: Loader, offline: CloudOff }[state.kind as string] ?? TriangleAlert;
  const tone = state.kind === "saved" || state.kind === "saving" ? null : styles.warning;
  const title = "why" in state ? state.why : undefined;
  return (
    <span className={classes(styles.mark, tone)} role="status" aria-label="Save state" title={title}>
      <Icon aria-hidden="true" className={styles.icon} />
      {wordsOf(state)}
      {!isKept && (
        <span title="This browser has no room to keep them. Leave this tab open.">, only in this tab</span>
      )}
    </span>
  );
}
