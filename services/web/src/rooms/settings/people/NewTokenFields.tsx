import { useQuery } from "@tanstack/react-query";
import { collectionsQuery } from "../../../api/queries";
import { ROLE_WORDS, type Role } from "../../../app/session/session";
import { Checkbox, Input, Notice, Select } from "../../../components";
import styles from "./NewTokenFields.module.css";

export interface TokenWish {
  role: Role;
  /** Collections that it opens; null for all. */
  scope: readonly number[] | null;
  days: number;
  note: string;
}

export const USUAL_WISH: TokenWish = { role: "annotator", scope: null, days: 30, note: "" };

const ROLE_MEANINGS: Readonly<Record<Role, string>> = {
  annotator: "May see shapes and label what the queue hands out.",
  reviewer: "May also change parts, accept and reject labels, and start trainings.",
  operator: "May also change settings, add and export files, take shapes away, and see figures of operation.",
  admin: "May also give out and revoke tokens, and read the audit trail.",
};

const TERMS = [
  { days: 1, label: "1 day" },
  { days: 7, label: "1 week" },
  { days: 30, label: "30 days" },
  { days: 90, label: "90 days" },
  { days: 365, label: "1 year" },
] as const;

interface NewTokenFieldsProps {
  wish: TokenWish;
  onChange: (wish: TokenWish) => void;
  error: string | null;
}

export function NewTokenFields({ wish, onChange, error }: NewTokenFieldsProps) {
  const roles = Object.keys(ROLE_MEANINGS) as Role[];
  return (
    <div className={styles.fields}>
      <Select
        label="Role"
        value={wish.role}
        options={roles.map((role) => ({ value: role, label: ROLE_WORDS[role] }))}
        hint={ROLE_MEANINGS[wish.role]}
        onChange={(role) => onChange({ ...wish, role })}
      />
      <Select
        label="Good for"
        value={String(wish.days)}
        options={TERMS.map(({ days, label }) => ({ value: String(days), label }))}
        onChange={(days) => onChange({ ...wish, days: Number(days) })}
      />
      <ScopeField scope={wish.scope} onChange={(scope) => onChange({ ...wish, scope })} />
      <Input
        label="Note"
        hint="What it is for, such as the computer it is used on. Optional."
        value={wish.note}
        maxLength={500}
        onChange={(event) => onChange({ ...wish, note: event.target.value })}
      />
      {error !== null && (
        <Notice kind="error" title="No token was made">
          {error}
        </Notice>
      )}
    </div>
  );
}

function ScopeField(props: {
  scope: readonly number[] | null;
  onChange: (scope: readonly number[] | null) => void;
}) {
  const { scope, onChange } = props;
  const collections = useQuery(collectionsQuery);
  const chosen = new Set(scope ?? []);
  return (
    <fieldset className={styles.scope}>
      <legend>Opens</legend>
      <Checkbox
        label="All collections"
        hint="Those that are made later, too. Needed to add people and collections."
        isChecked={scope === null}
        onChange={(isAll) => onChange(isAll ? null : [])}
      />
      {scope !== null && (
        <div className={styles.collections}>
          {collections.data?.items.map(({ id, name }) => (
            <Checkbox
              key={id}
              label={name}
              isChecked={chosen.has(id)}
              onChange={(isChosen) =>
                onChange(isChosen ? [...scope, id] : scope.filter((each) => each !== id))
              }
            />
          ))}
        </div>
      )}
    </fieldset>
  );
}
