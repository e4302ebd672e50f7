import { useQuery } from "@tanstack/react-query";
import { Select } from "../../../components";
import { peopleQuery } from "../rows/tableQueries";

const ANYBODY = "";

/** One person, or anybody. */
export function PersonChoice(props: {
  label: string;
  personId: number | null;
  onChange: (personId: number | null) => void;
}) {
  const people = useQuery(peopleQuery).data?.items ?? [];
  return (
    <Select
      label={props.label}
      value={props.personId === null ? ANYBODY : String(props.personId)}
      options={[
        { value: ANYBODY, label: "Anybody" },
        ...people.map(({ id, name }) => ({ value: String(id), label: name })),
      ]}
      onChange={(value) => props.onChange(value === ANYBODY ? null : Number(value))}
    />
  );
}
