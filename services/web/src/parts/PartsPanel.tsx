import { useQuery } from "@tanstack/react-query";
import { Plus } from "lucide-react";
import { useState } from "react";
import { partsQuery } from "../api/queries";
import { Button, Notice, Spinner } from "../components";
import { count } from "../components/numbers";
import { PartForm } from "./PartForm";
import { PartItem } from "./PartItem";
import styles from "./Parts.module.css";
import { asTree } from "./partDraft";
import type { Part } from "./partRequests";
import { RemovePartDialog } from "./RemovePartDialog";

const NEW = "new";

/** What faces may be labelled with; reviewers change it here. */
export function PartsPanel({ collectionId, mayChange }: { collectionId: number; mayChange: boolean }) {
  const schema = useQuery(partsQuery(collectionId));
  const [edited, setEdited] = useState<number | typeof NEW | null>(null);
  const [removed, setRemoved] = useState<Part | null>(null);
  if (schema.data === undefined) {
    if (schema.error === null) return <Spinner label="Reading the parts" />;
    return (
      <Notice
        kind="error"
        isCentred
        title="The parts could not be read"
        actions={<Button onClick={() => void schema.refetch()}>Try again</Button>}
      >
        {schema.error.message}
      </Notice>
    );
  }
  const { parts, version } = schema.data;
  const close = () => setEdited(null);
  return (
    <div className={styles.panel}>
      <p className={styles.about}>
        {count(parts.length, "part")}, version {version}.{" "}
        {mayChange
          ? "A part that is added or removed makes the next version, and labels made before it wait in Reviews; names, colours and explanations can change at any time."
          : "A reviewer can change them."}
      </p>
      <ol className={styles.list} aria-label="Parts">
        {asTree(parts).map(({ part, depth }) => (
          <li key={part.id} style={{ marginInlineStart: depth * 20 }}>
            {edited === part.id ? (
              <PartForm {...{ collectionId, parts, part }} onClose={close} />
            ) : (
              <PartItem
                part={part}
                number={parts.indexOf(part) + 1}
                mayChange={mayChange}
                onEdit={() => setEdited(part.id)}
                onRemove={() => setRemoved(part)}
              />
            )}
          </li>
        ))}
      </ol>
      {parts.length === 0 && edited === null && (
        <Notice kind="empty" title="No parts yet">
          Nothing can be labelled before there is one.
        </Notice>
      )}
      {edited === NEW && <PartForm {...{ collectionId, parts }} part={null} onClose={close} />}
      {mayChange && edited !== NEW && (
        <Button icon={<Plus />} className={styles.add ?? ""} onClick={() => setEdited(NEW)}>
          Add a part
        </Button>
      )}
      {removed && (
        <RemovePartDialog {...{ collectionId, version }} part={removed} onClose={() => setRemoved(null)} />
      )}
    </div>
  );
}
