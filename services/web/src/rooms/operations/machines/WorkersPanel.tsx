import { JOB_WORDS } from "../../../app/shell/jobWords";
import { Badge, type Column, DataTable, Panel } from "../../../components";
import { whole } from "../../../components/numbers";
import { durationInWords } from "../../../components/timeInWords";
import type { Ops } from "../queries";

type Worker = Ops["workers"][number];

/** A worker that says nothing for so long may have died. */
const SILENT_S = 60;

const COLUMNS: readonly Column<Worker>[] = [
  { id: "owner", header: "Worker", isWide: true, cell: ({ owner }) => <span title={owner}>{owner}</span> },
  { id: "job", header: "Job", cell: ({ job_kind }) => JOB_WORDS[job_kind].name },
  {
    id: "done",
    header: "Done",
    isNumber: true,
    cell: ({ done, total }) => (total === null ? whole(done) : `${whole(done)} of ${whole(total)}`),
  },
  { id: "sign", header: "Sign of life", cell: ({ silent_s }) => <Silence seconds={silent_s} /> },
];

/** Who is at a job, and whether it lives. */
export function WorkersPanel({ ops }: { ops: Ops | undefined }) {
  return (
    <Panel
      title="Workers"
      description="Those that are at a job. What a silent one was at is taken over by another."
      isFlush
    >
      <DataTable
        caption="Workers"
        columns={COLUMNS}
        rows={ops?.workers ?? []}
        keyOf={({ owner, job_id }) => `${owner} ${job_id}`}
        empty={
          ops ? (
            <>
              No worker is at a job. If jobs wait and nothing begins, start one with{" "}
              <code>partwise work</code>.
            </>
          ) : (
            "Reading…"
          )
        }
      />
    </Panel>
  );
}

function Silence({ seconds }: { seconds: number | null }) {
  if (seconds === null) return <Badge title="It has not said anything yet.">none yet</Badge>;
  if (seconds > SILENT_S) return <Badge tone="warning">silent for {durationInWords(seconds)}</Badge>;
  return <>{durationInWords(seconds)} ago</>;
}
