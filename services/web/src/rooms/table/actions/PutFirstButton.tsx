import { useMutation } from "@tanstack/react-query";
import { ListStart } from "lucide-react";
import { Button, useToast } from "../../../components";
import { count } from "../../../components/numbers";
import { putFirst } from "./actionRequests";

export interface PutFirstButtonProps {
  readonly collectionId: number;
  readonly shapeIds: readonly number[];
  /** Only so many of them, as far apart on the map as can be; null for all. */
  readonly spread?: number | null;
  readonly isDisabled?: boolean;
}

/** Has shapes handed out before all others. */
export function PutFirstButton({
  collectionId,
  shapeIds,
  spread = null,
  isDisabled = false,
}: PutFirstButtonProps) {
  const showToast = useToast();
  const putting = useMutation({
    mutationFn: () => putFirst(collectionId, shapeIds, spread),
    onError: (error) => showToast({ message: error.message, tone: "bad" }),
    onSuccess: ({ length }) => {
      const nOthers = spread === null ? shapeIds.length - length : 0;
      const others = nOthers > 0 ? `; ${count(nOthers, "other")} did not wait for labels` : "";
      if (length === 0) showToast({ message: "None of these shapes waits for labels, so nothing changed." });
      else showToast({ message: `${count(length, "shape")} put first in the queue${others}`, tone: "good" });
    },
  });
  return (
    <Button
      size="small"
      variant="quiet"
      icon={<ListStart />}
      isBusy={putting.isPending}
      disabled={isDisabled}
      onClick={() => putting.mutate()}
    >
      Put first in queue
    </Button>
  );
}
