import { useEffect, useState } from "react";
import { Button } from "../../../components";
import { count } from "../../../components/numbers";
import type { Divergence } from "../../../drafts/reconcile";
import type { OpenShape } from "../shape/openShape";
import { CompareBar } from "./CompareBar";
import { useTask } from "./useTask";

/** The draft went on elsewhere and here: the person chooses what to go on with, and neither side is lost. */
export function ConflictBar({ open, divergence }: { open: OpenShape; divergence: Divergence }) {
  const [theirs, setTheirs] = useState<Uint16Array | null>(null);
  const { mine, theirs: recorded } = divergence;
  const settling = useTask();
  // biome-ignore lint/correctness/useExhaustiveDependencies: another divergence has other sides
  useEffect(() => {
    void open.sidesOfConflict().then((sides) => setTheirs(sides?.theirs ?? null));
  }, [open, divergence]);
  return (
    <CompareBar
      open={open}
      title="You worked on this shape in two places"
      theirs={theirs}
      theirName="the saved one"
      actions={
        <>
          <Button
            variant="primary"
            isBusy={settling.isBusy}
            onClick={() => settling.run(() => open.keepMine())}
          >
            Put mine on top
          </Button>
          <Button isBusy={settling.isBusy} onClick={() => settling.run(() => open.draft.sender.takeTheirs())}>
            Take the saved one
          </Button>
        </>
      }
    >
      {`${count(recorded.length, "stroke")} saved from elsewhere, ${count(mine.length, "stroke")} only here. Yours on top change just the faces that you changed; if you take the saved ones, yours are set aside and can be put back.`}
    </CompareBar>
  );
}
