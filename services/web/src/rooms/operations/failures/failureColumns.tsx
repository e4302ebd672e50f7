import { Button, Checkbox, type Column, Time } from "../../../components";
import { whole } from "../../../components/numbers";
import type { Failure } from "../queries";
import { stageName } from "../stageWords";
import { FAILURE_WORDS } from "./failureWords";

interface FailureColumns {
  rows: readonly Failure[];
  chosen: ReadonlySet<number>;
  choose: (shapeIds: readonly number[], isChosen: boolean) => void;
  onShow: (failure: Failure) => void;
}

/** A failure's columns, with boxes to choose which are tried again. */
export function failureColumns({ rows, chosen, choose, onShow }: FailureColumns): readonly Column<Failure>[] {
  const ids = rows.map((row) => row.shape_id);
  const nChosen = ids.filter((id) => chosen.has(id)).length;
  return [
    {
      id: "choose",
      header: (
        <Checkbox
          label="Choose all failures shown"
          isLabelUnseen
          isChecked={ids.length > 0 && nChosen === ids.length}
          isMixed={nChosen > 0 && nChosen < ids.length}
          isDisabled={ids.length === 0}
          onChange={(isChosen) => choose(ids, isChosen)}
        />
      ),
      cell: ({ shape_id, source_key }) => (
        <Checkbox
          label={`Choose ${source_key}`}
          isLabelUnseen
          isChecked={chosen.has(shape_id)}
          onChange={(isChosen) => choose([shape_id], isChosen)}
        />
      ),
    },
    { id: "shape", header: "Shape", cell: ({ source_key }) => <Name text={source_key} /> },
    { id: "stage", header: "Stage", cell: ({ stage }) => stageName(stage) },
    {
      id: "reason",
      header: "Reason",
      isWide: true,
      cell: (failure) => <Reason failure={failure} />,
    },
    { id: "attempts", header: "Tries", isNumber: true, cell: ({ attempts }) => whole(attempts) },
    { id: "at", header: "Gave up", cell: ({ at }) => <Time at={at} /> },
    {
      id: "log",
      header: <span className="unseen">Actions</span>,
      cell: (failure) => (
        <Button size="small" aria-label={`Details of ${failure.source_key}`} onClick={() => onShow(failure)}>
          Details
        </Button>
      ),
    },
  ];
}

/** Reasons begin with the file's name, which stands beside them already. */
function Reason({ failure: { kind, message, source_key } }: { failure: Failure }) {
  const prefix = `${source_key}: `;
  return (
    <span title={message}>
      <strong>{FAILURE_WORDS[kind].name}:</strong>{" "}
      {message.startsWith(prefix) ? message.slice(prefix.length) : message}
    </span>
  );
}

const LONG_NAME = 28;

/** The end of a name tells more than its beginning. */
function Name({ text }: { text: string }) {
  return <span title={text}>{text.length > LONG_NAME ? `…${text.slice(1 - LONG_NAME)}` : text}</span>;
}
