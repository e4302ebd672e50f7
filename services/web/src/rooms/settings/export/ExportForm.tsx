import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { api, body, type Schemas } from "../../../api/client";
import { Button, Select } from "../../../components";
import styles from "./ExportForm.module.css";
import { type ExportWish, FORMATS, MESHES, meaningOf, SEGMENTATIONS } from "./exportWords";

interface ExportFormProps {
  collectionId: number;
  onAsked: (job: Schemas["JobOut"]) => void;
}

const USUAL: ExportWish = { segmentation: "confirmed", format: "seg", on: "working" };

/** Which labels, as what, on which mesh. */
export function ExportForm({ collectionId, onAsked }: ExportFormProps) {
  const [wish, setWish] = useState(USUAL);
  const queries = useQueryClient();
  const asking = useMutation({
    mutationFn: () =>
      body(
        api.POST("/api/v1/collections/{collection_id}/jobs", {
          params: { path: { collection_id: collectionId } },
          body: { kind: "export", parameters: wish },
        }),
      ),
    onSuccess: onAsked,
    onSettled: () => queries.invalidateQueries({ queryKey: ["jobs", collectionId] }),
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    asking.mutate();
  };
  return (
    <form onSubmit={submit} className={styles.form}>
      <Select
        label="Labels"
        value={wish.segmentation}
        options={SEGMENTATIONS}
        hint={meaningOf(SEGMENTATIONS, wish.segmentation)}
        onChange={(segmentation) => setWish({ ...wish, segmentation })}
      />
      <Select
        label="Format"
        value={wish.format}
        options={FORMATS}
        hint={meaningOf(FORMATS, wish.format)}
        onChange={(format) => setWish({ ...wish, format })}
      />
      <Select
        label="On"
        value={wish.on}
        options={MESHES}
        hint={meaningOf(MESHES, wish.on)}
        onChange={(on) => setWish({ ...wish, on })}
      />
      {asking.error && (
        <p role="alert" className={styles.error}>
          {asking.error.message}
        </p>
      )}
      <Button type="submit" variant="primary" isBusy={asking.isPending} className={styles.go}>
        Export
      </Button>
    </form>
  );
}
