import type { ReactNode } from "react";
import { Button, Notice } from "../../../components";
import { count } from "../../../components/numbers";
import type { LeaseEnd } from "../../../drafts/leaseKeeper";
import { useObservable } from "../../../drafts/useObservable";
import type { Desk } from "../desk/desk";
import type { HeldShape } from "../desk/heldShape";
import type { OpenShape } from "../shape/openShape";
import { AsidesElsewhere } from "./AsidesElsewhere";
import { ConflictBar } from "./ConflictBar";
import { SetAsideBar } from "./SetAsideBar";
import { useTask } from "./useTask";

export interface ShapeBannersProps {
  desk: Desk;
  held: HeldShape;
  open: OpenShape;
  /** Another notice tells already that the shape went to somebody else. */
  isLossTold: boolean;
  onLeave: () => void;
}

/** What the person must know about the shape in hand before they go on. */
export function ShapeBanners({ desk, held, open, isLossTold, onLeave }: ShapeBannersProps) {
  const lease = useObservable(held.keeper.state);
  const role = useObservable(open.draft.right.role);
  const isConfirmedElsewhere = useObservable(open.draft.isConfirmedElsewhere);
  const save = useObservable(open.draft.sender.state);
  const startTrouble = useObservable(held.startTrouble);
  const leave = <Button onClick={onLeave}>Go to the next shape</Button>;
  if (isConfirmedElsewhere) {
    return (
      <Notice title="You confirmed this shape elsewhere" actions={leave}>
        There is nothing left to do here.
      </Notice>
    );
  }
  return (
    <>
      {lease.kind === "lost" && !isLossTold && (
        <Notice kind="warning" title="This shape is not yours any more" actions={leave}>
          {sentence(lease.why)} Your strokes are kept.
        </Notice>
      )}
      {lease.kind === "ended" && !isLossTold && <Ended held={held} how={lease.how} leave={leave} />}
      {startTrouble !== null && (
        <Notice kind="warning" title="The shape begins without labels">
          Those to start from do not fit it: {startTrouble}.
        </Notice>
      )}
      {role === "watching" && <Watching open={open} />}
      {role === "editing" && save.kind === "conflict" && (
        <ConflictBar open={open} divergence={save.divergence} />
      )}
      {role === "editing" && (save.kind === "closed" || save.kind === "refused") && save.nQueued > 0 && (
        <Withdrawn open={open} title={titleOfRefusal(save.kind, save.nQueued)} why={save.why} leave={leave} />
      )}
      {save.kind === "closed" && save.nQueued === 0 && (
        <Notice title="This draft was closed elsewhere" actions={leave}>
          What came after is set aside. It can be put on top once you have the shape in hand again.
        </Notice>
      )}
      <SetAsideBar open={open} />
      <AsidesElsewhere
        outbox={open.draft.sender.outbox}
        draft={open.draft.sender.draft}
        onTake={(shapeId) => void desk.takeNamed(shapeId)}
      />
    </>
  );
}

const ENDED: Readonly<Record<LeaseEnd, string>> = {
  "taken-away": "An operator took this shape back",
  "given-back": "You gave this shape back elsewhere",
  confirmed: "You confirmed this shape elsewhere",
};

/** The shape was freed: the person may go on elsewhere, or ask for it again. */
function Ended({ held, how, leave }: { held: HeldShape; how: LeaseEnd; leave: ReactNode }) {
  const asking = useTask();
  return (
    <Notice
      title={ENDED[how]}
      actions={
        <>
          {leave}
          <Button
            variant="quiet"
            isBusy={asking.isBusy}
            onClick={() => asking.run(() => held.keeper.claimBack())}
          >
            Ask for it again
          </Button>
        </>
      }
    >
      Nothing is lost: your strokes are kept, and are there if you get the shape again.
    </Notice>
  );
}

function Watching({ open }: { open: OpenShape }) {
  return (
    <Notice
      title="You have this shape open in another tab"
      actions={
        <Button variant="primary" onClick={() => void open.draft.right.takeOver()}>
          Take over here
        </Button>
      }
    >
      Strokes made there show here. One tab edits at a time.
    </Notice>
  );
}

function Withdrawn(props: { open: OpenShape; title: string; why: string; leave: ReactNode }) {
  const withdrawing = useTask();
  return (
    <Notice
      kind="error"
      title={props.title}
      actions={
        <>
          <Button
            isBusy={withdrawing.isBusy}
            onClick={() => withdrawing.run(() => props.open.draft.sender.withdraw())}
          >
            Set them aside
          </Button>
          {props.leave}
        </>
      }
    >
      {sentence(props.why)}
    </Notice>
  );
}

function sentence(words: string): string {
  const begun = words.charAt(0).toUpperCase() + words.slice(1);
  return /[.!?]$/.test(begun) ? begun : `${begun}.`;
}

function titleOfRefusal(kind: "closed" | "refused", nQueued: number): string {
  const strokes = count(nQueued, "stroke");
  return kind === "closed"
    ? `${strokes} came after this draft was closed elsewhere`
    : `The service does not take ${strokes}`;
}
