import { useMutation } from "@tanstack/react-query";
import { useState } from "react";
import { Checkbox, TextArea } from "../../../components";
import { count } from "../../../components/numbers";
import { ActionDialog } from "./ActionDialog";
import { sendBack } from "./actionRequests";
import type { ShapeActionProps } from "./shapeAction";

const MAX_NOTE = 2_000;

/** Sends the newest labels of shapes back, with a note for whoever gets them next. */
export function SendBackDialog({ collectionId, rows, teller, onActed, onClose }: ShapeActionProps) {
  const [note, setNote] = useState("");
  const [forAuthor, setForAuthor] = useState(false);
  const sending = useMutation({
    mutationFn: () => sendBack(collectionId, [...rows.keys()], note.trim(), forAuthor),
    onSuccess: (outcome) => {
      onClose();
      onActed([...rows.keys()]);
      teller.tell(outcome, rows, "sent back");
    },
  });
  return (
    <ActionDialog
      title={`Send back ${count(rows.size, "shape")}`}
      verb="Send back"
      isReady={note.trim() !== ""}
      isBusy={sending.isPending}
      error={sending.error}
      onConfirm={() => sending.mutate()}
      onClose={onClose}
    >
      <TextArea
        label="Note"
        hint="What is wrong, for whoever labels them next."
        rows={4}
        maxLength={MAX_NOTE}
        value={note}
        onChange={(event) => setNote(event.target.value)}
      />
      <Checkbox
        label="Only whoever labelled a shape gets it again"
        isChecked={forAuthor}
        onChange={setForAuthor}
      />
      <p>Their labels are no longer trained on until better ones are confirmed.</p>
    </ActionDialog>
  );
}
