import { useMutation } from "@tanstack/react-query";
import { useState } from "react";
import { useToast } from "../../../components";
import { count } from "../../../components/numbers";
import { ActionDialog } from "./ActionDialog";
import { assign } from "./actionRequests";
import { PersonChoice } from "./PersonChoice";
import type { ShapeActionProps } from "./shapeAction";

/** Keeps shapes that wait for one person, or lets anybody have them again. */
export function AssignDialog({ collectionId, rows, onClose }: ShapeActionProps) {
  const showToast = useToast();
  const [personId, setPersonId] = useState<number | null>(null);
  const ids = [...rows.keys()];
  const assigning = useMutation({
    mutationFn: (person: number | null) => assign(collectionId, ids, person),
    onSuccess: ({ n_places }, person) => {
      onClose();
      const undo = { label: "Undo", onSelect: () => assigning.mutate(null) };
      const words =
        person === null ? "may be had by anybody" : n_places === 1 ? "is assigned" : "are assigned";
      if (n_places === 0)
        showToast({ message: "None of these shapes waits in the queue, so nothing changed." });
      else {
        const message = `${count(n_places, "waiting label")} ${words}`;
        showToast({ message, tone: "good", ...(person === null ? {} : { action: undo }) });
      }
    },
  });
  return (
    <ActionDialog
      title={`Assign ${count(rows.size, "shape")}`}
      verb="Assign"
      isBusy={assigning.isPending}
      error={assigning.error}
      onConfirm={() => assigning.mutate(personId)}
      onClose={onClose}
    >
      <PersonChoice label="To" personId={personId} onChange={setPersonId} />
      <p>Nobody else gets them from the queue. Shapes that do not wait in the queue are left as they are.</p>
    </ActionDialog>
  );
}
