import { useQuery } from "@tanstack/react-query";
import { Select } from "../../../components";
import { peopleQuery } from "../rows/tableQueries";

const NOT_CHOSEN = "?";
const ANYBODY = "";

/** One person, or anybody (null); undefined while that has not been chosen. */
export function PersonChoice(props: {
  label: string;
  personId: number | null | undefined;
  onChange: (personId: number | null) => void;
}) {
  const { label, personId, onChange } = props;
  const people = useQuery(peopleQuery).data?.items ?? [];
  return (
    <Select
      label={label}
      value={personId === undefined ? NOT_CHOSEN : personId === null ? ANYBODY : String(personId)}
      options={[
        ...(personId === undefined ? [{ value: NOT_CHOSEN, label: "Choose…", isDisabled: true }] : []),
        { value: ANYBODY, label: "Anybody" },
        ...people.map(({ id, name }) => ({ value: String(id), label: name })),
      ]}
      onChange={(value) => onChange(value === ANYBODY ? null : Number(value))}
    />
  );
}
