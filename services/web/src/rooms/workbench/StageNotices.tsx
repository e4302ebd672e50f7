import { useState } from "react";
import { Button, Notice } from "../../components";
import { useObservable } from "../../drafts/useObservable";
import type { Desk } from "./desk/desk";
import type { HeldShape } from "./desk/heldShape";
import type { Confirming } from "./desk/useConfirming";
import { ShapeBanners } from "./dialogs/ShapeBanners";
import { UnseenLabelsBar } from "./dialogs/UnseenLabelsBar";
import type { OpenShape } from "./shape/openShape";
import styles from "./Workbench.module.css";

export interface StageNoticesProps {
  desk: Desk;
  held: HeldShape;
  open: OpenShape | null;
  confirming: Confirming;
}

/** What is said above the stage: about the shape in hand, and about shapes that were not to be had. */
export function StageNotices({ desk, held, open, confirming }: StageNoticesProps) {
  const { refused, why } = useObservable(desk.state);
  const leave = () => void desk.leave(held);
  return (
    <>
      <p className="unseen" role="status">
        {confirming.lastConfirmed !== null && `${confirming.lastConfirmed} is confirmed.`}
      </p>
      {refused.length > 0 && (
        <Notice
          kind="warning"
          title={
            refused.length === 1 ? "One shape is not to be had" : `${refused.length} shapes are not to be had`
          }
          actions={
            <Button size="small" onClick={() => desk.dismissRefusals()}>
              All right
            </Button>
          }
        >
          {refused.map((each) => each.why).join(" ")}
        </Notice>
      )}
      {why !== null && (
        <Notice kind="error" title="That did not work">
          {why}
        </Notice>
      )}
      <ReworkNote key={held.shapeId} held={held} />
      {open !== null && confirming.unseenRevision !== null && (
        <UnseenLabelsBar
          open={open}
          revisionId={confirming.unseenRevision}
          onConfirmOver={() => void confirming.confirmOver()}
          onLeave={() => void desk.release(held)}
        />
      )}
      {open !== null && (
        <ShapeBanners
          {...{ desk, held, open }}
          isLossTold={confirming.unseenRevision !== null}
          onLeave={leave}
        />
      )}
    </>
  );
}

function ReworkNote({ held }: { held: HeldShape }) {
  const note = useObservable(held.reworkNote);
  const [isRead, setRead] = useState(false);
  if (note === null || isRead) return null;
  return (
    <Notice
      kind="warning"
      title="These labels were sent back"
      actions={
        <Button size="small" onClick={() => setRead(true)}>
          I have read it
        </Button>
      }
    >
      <span className={styles.note}>{note === "" ? "Without a note: look for what is wrong." : note}</span>
    </Notice>
  );
}
