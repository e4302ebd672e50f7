import { useQuery } from "@tanstack/react-query";
import { Button, Dialog, Notice } from "../components";
import { count } from "../components/numbers";
import { countQuery } from "../rooms/table/rows/tableQueries";
import { NO_FILTERS } from "../rooms/table/view/tableView";
import styles from "./Parts.module.css";
import { type Part, useRemovePart } from "./partRequests";

export interface RemovePartDialogProps {
  readonly collectionId: number;
  readonly version: number;
  readonly part: Part;
  onClose(): void;
}

/** Says what removing a part means before it is done. */
export function RemovePartDialog({ collectionId, version, part, onClose }: RemovePartDialogProps) {
  const removing = useRemovePart(collectionId);
  const nShapes = useQuery(countQuery(collectionId, { ...NO_FILTERS, part: part.id })).data;
  const isUsed = nShapes !== undefined && nShapes > 0;
  return (
    <Dialog
      title={`Remove ${part.name}`}
      size="small"
      isAlert
      onClose={onClose}
      footer={
        <>
          <Button onClick={onClose}>Cancel</Button>
          <Button
            variant="danger"
            isBusy={removing.isPending}
            disabled={nShapes === undefined || isUsed}
            onClick={() => removing.mutate(part.id, { onSuccess: onClose })}
          >
            Remove
          </Button>
        </>
      }
    >
      <div className={styles.form}>
        {isUsed ? (
          <Notice kind="warning" title={`It is in the labels of ${count(nShapes, "shape")}`}>
            A part in use is not removed. Filter the table by it, label those faces otherwise, then remove it.
          </Notice>
        ) : (
          <p>
            Nobody can label faces with it any more. This makes version {version + 1} of the parts; labels
            made under earlier ones stay as they are, and wait in Reviews before a model is trained on them.
          </p>
        )}
        {removing.error && (
          <Notice kind="error" title="The part was not removed">
            {removing.error.message}
          </Notice>
        )}
      </div>
    </Dialog>
  );
}
