import { JOB_WORDS } from "../../../app/shell/jobWords";
import { Badge, type Column, DataTable, Panel } from "../../../components";
import { bytes, count, whole } from "../../../components/numbers";
import { durationInWords } from "../../../components/timeInWords";
import type { Ops } from "../queries";

type Worker = Ops["workers"][number];

/** A worker that says nothing for so long may have died. */
const SILENT_S = 60;

const COLUMNS: readonly Column<Worker>[] = [
  { id: "owner", header: "Worker", isWide: true, cell: ({ owner }) => <span title={owner}>{owner}</span> },
  { id: "job", header: "Job", cell: (worker) => jobInWords(worker) },
  { id: "done", header: "Done", isNumber: true, cell: (worker) => doneInWords(worker) },
  {
    id: "memory",
    header: "Memory",
    isNumber: true,
    cell: ({ usage }) => (usage ? bytes(usage.memory_bytes) : "–"),
  },
  { id: "processes", header: "Its processes", isNumber: true, cell: ({ usage }) => processes(usage) },
  {
    id: "free",
    header: "Disk left",
    isNumber: true,
    cell: ({ usage }) =>
      usage && usage.free_bytes !== null ? (
        bytes(usage.free_bytes)
      ) : (
        <span title="Not known, or the arrays are not on a disk of its machine.">–</span>
      ),
  },
  { id: "sign", header: "Sign of life", cell: ({ silent_s }) => <Silence seconds={silent_s} /> },
];

/** Who does jobs, what it takes, and whether it lives. */
export function WorkersPanel({ ops, className }: { ops: Ops | undefined; className?: string | undefined }) {
  return (
    <Panel
      title="Workers"
      className={className}
      description="Memory is that in use now. Processes compute shapes for a worker, wherever they run. What a silent one was at is taken over by another."
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
              No worker is there, so nothing that waits will begin. Start one with <code>partwise work</code>.
            </>
          ) : (
            "Reading…"
          )
        }
      />
    </Panel>
  );
}

function jobInWords({ job_kind, is_busy }: Worker) {
  if (job_kind !== null) return JOB_WORDS[job_kind].name;
  return is_busy ? "At another collection" : "Waits for a job";
}

function doneInWords({ done, total }: Worker): string {
  if (done === null) return "–";
  return total === null ? whole(done) : `${whole(done)} of ${whole(total)}`;
}

function processes(usage: Worker["usage"]): string {
  if (usage === null) return "–";
  return usage.n_actors === 0
    ? "none"
    : `${bytes(usage.actor_bytes)} in ${count(usage.n_actors, "process", "processes")}`;
}

function Silence({ seconds }: { seconds: number | null }) {
  if (seconds === null) return <Badge title="It has not said anything yet.">none yet</Badge>;
  if (seconds > SILENT_S) return <Badge tone="warning">silent for {durationInWords(seconds)}</Badge>;
  return <>{durationInWords(seconds)} ago</>;
}
