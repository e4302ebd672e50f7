import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { api, body } from "../../../api/client";
import { collectionsQuery } from "../../../api/queries";
import { useCollection } from "../../../app/CollectionContext";
import { Button, Notice, Panel, useToast } from "../../../components";
import { type CollectionSettings, changesBetween, settingsOf } from "./defaults";
import styles from "./LabellingSection.module.css";
import { MeshFields } from "./MeshFields";
import { QueueFields } from "./QueueFields";

/** How a collection is labelled, and what its meshes should be like. */
export function LabellingSection() {
  const collection = useCollection();
  const saved = settingsOf(collection);
  const [changes, setChanges] = useState<Partial<CollectionSettings>>({});
  const wanted = { ...saved, ...changes };
  const changed = changesBetween(saved, wanted);
  const nChanged = Object.keys(changed).length;
  const save = useSaveSettings(collection.id, changed, () => setChanges({}));
  const change = (part: Partial<CollectionSettings>) => setChanges((before) => ({ ...before, ...part }));
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (nChanged > 0) save.mutate();
  };
  return (
    <form onSubmit={submit} className={styles.form}>
      <Panel title="Labels" description="How many people label each shape, and when a label counts.">
        <QueueFields settings={wanted} onChange={change} />
      </Panel>
      <Panel title="Meshes" description="What the surfaces that people label are like.">
        <MeshFields settings={wanted} onChange={change} />
        {(changed.working_faces !== undefined || changed.remesh !== undefined) && (
          <Notice kind="warning" title="Meshes will be made anew">
            The shapes are remeshed and described again the next time they are prepared. Labels move along to
            the new surfaces, and what they were made on is kept.
          </Notice>
        )}
      </Panel>
      {save.error && (
        <Notice kind="error" title="Nothing was changed">
          {save.error.message}
        </Notice>
      )}
      <div className={styles.bar}>
        <span className={styles.note} role="status">
          {nChanged === 0 ? "Everything is saved." : nChanged === 1 ? "1 change" : `${nChanged} changes`}
        </span>
        <Button disabled={nChanged === 0 || save.isPending} onClick={() => setChanges({})}>
          Undo
        </Button>
        <Button type="submit" variant="primary" disabled={nChanged === 0} isBusy={save.isPending}>
          Save changes
        </Button>
      </div>
    </form>
  );
}

function useSaveSettings(collectionId: number, changed: Partial<CollectionSettings>, onSaved: () => void) {
  const queries = useQueryClient();
  const toast = useToast();
  return useMutation({
    mutationFn: () =>
      body(
        api.PATCH("/api/v1/collections/{collection_id}/settings", {
          params: { path: { collection_id: collectionId } },
          body: changed,
        }),
      ),
    onSuccess: async () => {
      await queries.invalidateQueries({ queryKey: collectionsQuery.queryKey });
      onSaved();
      toast({ message: "Settings saved.", tone: "good" });
    },
  });
}
