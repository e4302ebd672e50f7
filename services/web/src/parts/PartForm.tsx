import { type FormEvent, useEffect, useRef, useState } from "react";
import { Button, Input, Notice, Select, TextArea } from "../components";
import { ColourChoice } from "./ColourChoice";
import styles from "./Parts.module.css";
import { draftOf, nameError, newDraft, possibleParents } from "./partDraft";
import { type Part, useSavePart } from "./partRequests";

const TOP = "";
const MAX_GLOSS = 2_000;

export interface PartFormProps {
  readonly collectionId: number;
  readonly parts: readonly Part[];
  /** Null adds one. */
  readonly part: Part | null;
  onClose(): void;
}

/** A part's name, colour, explanation and place. */
export function PartForm({ collectionId, parts, part, onClose }: PartFormProps) {
  const [draft, setDraft] = useState(() => (part ? draftOf(part) : newDraft(parts)));
  const [isTried, setTried] = useState(false);
  const saving = useSavePart(collectionId);
  const others = parts.filter((each) => each.id !== part?.id);
  const error = nameError(draft, others);
  const form = useRef<HTMLFormElement>(null);
  useEffect(() => {
    form.current?.scrollIntoView({ block: "nearest" }); // returns a promise in newer browsers
  }, []);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    setTried(true);
    if (error !== null) return;
    const named = { ...draft, name: draft.name.trim(), gloss: draft.gloss.trim() };
    saving.mutate({ partId: part?.id ?? null, draft: named }, { onSuccess: onClose });
  };
  return (
    <form
      ref={form}
      className={styles.form}
      aria-label={part ? `Change ${part.name}` : "New part"}
      onSubmit={submit}
      onKeyDown={(event) => event.key === "Escape" && onClose()}
    >
      <Input
        label="Name"
        autoFocus
        autoComplete="off"
        value={draft.name}
        error={isTried ? error : null}
        onChange={(event) => setDraft({ ...draft, name: event.target.value })}
      />
      <ColourChoice
        colour={draft.colour}
        others={new Map(others.map((each) => [each.name, each.colour]))}
        onChange={(colour) => setDraft({ ...draft, colour })}
      />
      <TextArea
        label="Explanation"
        hint="What belongs to it, for those who label."
        rows={2}
        maxLength={MAX_GLOSS}
        value={draft.gloss}
        onChange={(event) => setDraft({ ...draft, gloss: event.target.value })}
      />
      {others.length > 0 && (
        <Select
          label="Part of"
          value={draft.parentId === null ? TOP : String(draft.parentId)}
          options={[
            { value: TOP, label: "Nothing: it stands by itself" },
            ...possibleParents(parts, part?.id ?? null).map(({ id, name }) => ({
              value: String(id),
              label: name,
            })),
          ]}
          onChange={(value) => setDraft({ ...draft, parentId: value === TOP ? null : Number(value) })}
        />
      )}
      {saving.error && (
        <Notice kind="error" title="The part was not saved">
          {saving.error.message}
        </Notice>
      )}
      <div className={styles.formButtons}>
        <Button size="small" onClick={onClose}>
          Cancel
        </Button>
        <Button size="small" variant="primary" type="submit" isBusy={saving.isPending}>
          {part ? "Save" : "Add"}
        </Button>
      </div>
    </form>
  );
}
