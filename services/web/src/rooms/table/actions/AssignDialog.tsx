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
  const [personId, setPersonId] = useState<number | null>();
  const ids = [...rows.keys()];
  const assigning = useMutation({
    mutationFn: (person: number | null) => assign(collectionId, ids, person),
    onSuccess: ({ n_places }, person) => {
      onClose();
      if (n_places === 0) {
        showToast({ message: "None of these shapes waits in the queue, so nothing changed." });
        return;
      }
      const words =
        person === null ? "may be had by anybody" : n_places === 1 ? "is assigned" : "are assigned";
      showToast({ message: `${count(n_places, "waiting label")} ${words}`, tone: "good" });
    },
  });
  return (
    <ActionDialog
      title={`Assign ${count(rows.size, "shape")}`}
      verb={personId === null ? "Let anybody have them" : "Assign"}
      isReady={personId !== undefined}
      isBusy={assigning.isPending}
      error={assigning.error}
      onConfirm={() => personId !== undefined && assigning.mutate(personId)}
      onClose={onClose}
    >
      <PersonChoice label="To" personId={personId} onChange={setPersonId} />
      <p>
        {personId === null
          ? "Whoever is next gets them from the queue."
          : "Nobody else gets them from the queue."}{" "}
        This takes the place of earlier assignments. Shapes that do not wait in the queue are left as they
        are.
      </p>
    </ActionDialog>
  );
}
