import { useQuery } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { Button, Input, Notice, Panel, Select, useToast } from "../../../components";
import styles from "./PrefixForm.module.css";
import { prefixesQuery } from "./queries";
import { useIngest } from "./useIngest";

/** Files that lie where the service runs, below folders that its operator has listed. */
export function PrefixForm({ collectionId }: { collectionId: number }) {
  const prefixes = useQuery(prefixesQuery);
  const names = prefixes.data?.items ?? [];
  const [chosen, setChosen] = useState<string | null>(null);
  const [path, setPath] = useState("");
  const prefix = chosen ?? names[0] ?? "";
  const ingest = useIngest(collectionId);
  const toast = useToast();
  const submit = (event: FormEvent) => {
    event.preventDefault();
    ingest.mutate(
      { prefix, ...(path.trim() !== "" && { path: path.trim() }) },
      {
        onSuccess: () =>
          toast({ message: "The files are taken in as soon as a worker is free.", tone: "good" }),
      },
    );
  };
  return (
    <Panel title="From the service’s own folders" description="For data that is too large to send.">
      {prefixes.error && (
        <Notice kind="error" title="The folders could not be read">
          {prefixes.error.message}
        </Notice>
      )}
      {prefixes.data && names.length === 0 && (
        <Notice title="No folder is listed">
          Whoever runs the service lists folders in <code>PARTWISE_SERVICE_INGEST_PREFIXES</code>, or adds
          files with <code>partwise ingest</code>.
        </Notice>
      )}
      {names.length > 0 && (
        <form onSubmit={submit} className={styles.form}>
          <Select
            label="Folder"
            value={prefix}
            options={names.map((name) => ({ value: name, label: name }))}
            onChange={setChosen}
          />
          <Input
            label="Path below it"
            placeholder="All of it"
            value={path}
            onChange={(event) => setPath(event.target.value)}
          />
          <Button type="submit" isBusy={ingest.isPending}>
            Take in
          </Button>
        </form>
      )}
    </Panel>
  );
}
