import { useMutation } from "@tanstack/react-query";
import { useState } from "react";
import { count } from "../../../components/numbers";
import { ActionDialog } from "./ActionDialog";
import { putBack } from "./actionRequests";
import { askForEach } from "./outcome";
import { PersonChoice } from "./PersonChoice";
import type { ShapeActionProps } from "./shapeAction";

/** Puts shapes first in the queue for another round. */
export function PutBackDialog({ rows, teller, onClose }: ShapeActionProps) {
  const [personId, setPersonId] = useState<number | null>(null);
  const [nAsked, setAsked] = useState(0);
  const putting = useMutation({
    mutationFn: () => askForEach([...rows.keys()], (id) => putBack(id, personId), setAsked),
    onSuccess: (outcome) => {
      onClose();
      teller.tell(outcome, rows, "put back in the queue");
    },
  });
  return (
    <ActionDialog
      title={`Put ${count(rows.size, "shape")} back in the queue`}
      verb="Put back"
      isBusy={putting.isPending}
      progress={{ n: nAsked, of: rows.size }}
      error={putting.error}
      onConfirm={() => putting.mutate()}
      onClose={onClose}
    >
      <PersonChoice label="For" personId={personId} onChange={setPersonId} />
      <p>They come first in the queue for another round. The labels that they have stay on record.</p>
    </ActionDialog>
  );
}
