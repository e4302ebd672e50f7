import { useEffect, useState } from "react";
import { Button } from "../../../components";
import type { OpenShape } from "../shape/openShape";
import { fetchRevision } from "../shape/shapeRequests";
import { CompareBar } from "./CompareBar";

export interface UnseenLabelsBarProps {
  open: OpenShape;
  revisionId: number;
  onConfirmOver: () => void;
  onLeave: () => void;
}

/** Somebody else confirmed labels meanwhile: they must be looked at before others take their place. */
export function UnseenLabelsBar({ open, revisionId, onConfirmOver, onLeave }: UnseenLabelsBarProps) {
  const [theirs, setTheirs] = useState<Uint16Array | null>(null);
  const [why, setWhy] = useState<string | null>(null);
  useEffect(() => {
    fetchRevision(open.draft.draft.shape_id, revisionId).then(
      (labels) => {
        if (labels.length === open.labels.length) setTheirs(labels);
        else setWhy("They are on another version of the surface, so they cannot be shown on this one.");
      },
      (error: unknown) => setWhy(error instanceof Error ? error.message : String(error)),
    );
  }, [open, revisionId]);
  return (
    <CompareBar
      open={open}
      title="Somebody else confirmed this shape meanwhile"
      theirs={theirs}
      theirName="theirs"
      actions={
        <>
          <Button variant="primary" disabled={theirs === null && why === null} onClick={onConfirmOver}>
            Confirm mine over theirs
          </Button>
          <Button onClick={onLeave}>Leave theirs</Button>
        </>
      }
    >
      {why ?? "Look at both. Theirs stay on record whatever you do; your draft stays, too."}
    </CompareBar>
  );
}
