import { Select } from "../../../components";
import type { FailureFilter, FailureKind, Ops } from "../queries";
import { stageName } from "../stageWords";
import { FAILURE_WORDS } from "./failureWords";

/** Which failures are shown. */
export function FailureFilters(props: {
  ops: Ops | undefined;
  filter: FailureFilter;
  onChange: (part: Partial<FailureFilter>) => void;
}) {
  const { ops, filter, onChange } = props;
  const kinds = Object.keys(FAILURE_WORDS) as FailureKind[];
  return (
    <>
      <Select
        label="Kind of failure"
        isLabelUnseen
        size="small"
        value={filter.kind ?? ""}
        options={[
          { value: "", label: "All kinds" },
          ...kinds.map((kind) => ({ value: kind, label: FAILURE_WORDS[kind].name })),
        ]}
        onChange={(kind) => onChange({ kind: kind === "" ? null : kind })}
      />
      <Select
        label="Stage that failed"
        isLabelUnseen
        size="small"
        value={filter.stage ?? ""}
        options={[
          { value: "", label: "All stages" },
          ...(ops?.stages ?? []).map(({ stage }) => ({ value: stage, label: stageName(stage) })),
        ]}
        onChange={(stage) => onChange({ stage: stage === "" ? null : stage })}
      />
    </>
  );
}
