import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { Input, Notice, Segmented } from "../../../components";
import { count } from "../../../components/numbers";
import { ActionDialog } from "./ActionDialog";
import styles from "./Actions.module.css";
import { acceptable, type ModelLabels, suggestedRechecks, versionsWords } from "./acceptance";
import { accept } from "./actionRequests";
import type { ShapeActionProps } from "./shapeAction";

/** Makes a model's labels those of many shapes, and has a few of them labelled by people who are told nothing. */
export function AcceptDialog({ collectionId, rows, teller, onActed, onClose }: ShapeActionProps) {
  const client = useQueryClient();
  const [labels, setLabels] = useState<ModelLabels>("refined");
  const [asked, setAsked] = useState<number | null>(null);
  const fit = acceptable(rows.values(), labels);
  const rechecks = asked ?? suggestedRechecks(fit.length);
  const nLeft = rows.size - fit.length;
  const accepting = useMutation({
    mutationFn: (shapeIds: readonly number[]) => accept(collectionId, shapeIds, labels, rechecks),
    onSuccess: (outcome, shapeIds) => {
      onClose();
      onActed(shapeIds);
      void client.invalidateQueries({ queryKey: ["accepts", collectionId] });
      const blind =
        outcome.rechecks > 0
          ? `accepted, ${count(outcome.rechecks, "other")} queued for a blind check`
          : "accepted";
      teller.tell(outcome, rows, blind, "accepted");
    },
  });
  const isValid = Number.isInteger(rechecks) && rechecks >= 0 && rechecks <= fit.length;
  return (
    <ActionDialog
      title={`Accept labels of ${count(fit.length, "shape")}`}
      verb={`Accept ${count(Math.max(0, fit.length - (isValid ? rechecks : 0)), "shape")}`}
      isReady={fit.length > 0 && isValid}
      isBusy={accepting.isPending}
      error={accepting.error}
      onConfirm={() => accepting.mutate(fit.map((row) => row.id))}
      onClose={onClose}
    >
      <Segmented
        label="Labels to accept"
        className={styles.choice ?? ""}
        value={labels}
        options={[
          { value: "refined", label: "Refined" },
          { value: "predicted", label: "Predicted" },
        ]}
        onChange={setLabels}
      />
      {fit.length === 0 ? (
        <Notice kind="warning" title={`None of these shapes waits with ${labels} labels`}>
          Only shapes that are ready, with labels of a model, can be accepted.
        </Notice>
      ) : (
        <>
          <p>
            The {labels} labels, of {versionsWords(fit, labels)}, become those of the shapes and are trained
            on.
            {nLeft > 0 &&
              ` ${count(nLeft, "selected shape")} without such labels, or not waiting, are left out.`}
          </p>
          <div className={styles.row}>
            <Input
              label="Blind re-check"
              type="number"
              min={0}
              max={fit.length}
              unit={`of ${fit.length}`}
              value={Number.isNaN(rechecks) ? "" : rechecks}
              error={isValid ? null : `Give a whole number from 0 to ${fit.length}.`}
              onChange={(event) => setAsked(event.target.valueAsNumber)}
              hint="So many, drawn at random, are labelled anew by people who are not told. How often they differ is the false-accept rate, shown with the reviews."
            />
          </div>
        </>
      )}
    </ActionDialog>
  );
}
