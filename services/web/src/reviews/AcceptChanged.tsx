import { useQuery } from "@tanstack/react-query";
import { CheckCheck } from "lucide-react";
import { useState } from "react";
import { Button, Dialog, Notice } from "../components";
import { count, whole } from "../components/numbers";
import { reviewCountQuery, useAcceptChanged } from "./reviewRequests";

/** Accepts at once what waits only since parts have changed, where that is more than one. */
export function AcceptChanged({ collectionId }: { collectionId: number }) {
  const nWaiting = useQuery(reviewCountQuery(collectionId, "schema")).data ?? 0;
  const [isAsking, setIsAsking] = useState(false);
  const accepting = useAcceptChanged(collectionId);
  const leave = () => {
    setIsAsking(false);
    accepting.reset();
  };
  return (
    <>
      {nWaiting > 1 && (
        <Button icon={<CheckCheck />} onClick={() => setIsAsking(true)}>
          Accept all {whole(nWaiting)} whose parts have changed
        </Button>
      )}
      {isAsking && (
        <Dialog
          title="Accept all whose parts have changed?"
          size="small"
          isAlert
          onClose={leave}
          footer={
            <>
              <Button onClick={leave}>Cancel</Button>
              <Button
                variant="primary"
                isBusy={accepting.isPending}
                onClick={() => accepting.mutate(undefined, { onSuccess: leave })}
              >
                Accept all
              </Button>
            </>
          }
        >
          <p>
            The labels of {count(nWaiting, "shape")} were made under other parts than the present ones. The
            next model is trained on them as they are: right if none of these shapes has a part that was added
            since.
          </p>
          {accepting.error && (
            <Notice kind="error" title="They were not accepted">
              {accepting.error.message}
            </Notice>
          )}
        </Dialog>
      )}
    </>
  );
}
