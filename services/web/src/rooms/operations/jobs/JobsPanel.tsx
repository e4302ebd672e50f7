import { useInfiniteQuery } from "@tanstack/react-query";
import { JOB_WORDS } from "../../../app/shell/jobWords";
import { type Column, DataTable, Panel, Time } from "../../../components";
import { LoadMore } from "../LoadMore";
import { PanelError } from "../PanelError";
import { type Job, jobsQuery } from "../queries";
import { JobActions } from "./JobActions";
import { JobStanding } from "./JobStanding";
import { StartJob } from "./StartJob";

const COLUMNS: readonly Column<Job>[] = [
  {
    id: "kind",
    header: "Job",
    cell: ({ kind }) => <span title={JOB_WORDS[kind].meaning}>{JOB_WORDS[kind].name}</span>,
  },
  { id: "standing", header: "Standing", isWide: true, cell: (job) => <JobStanding job={job} /> },
  {
    id: "attempts",
    header: "Begun",
    cell: (job) =>
      job.started_at ? <Time at={job.started_at} /> : <span title="No worker has taken it yet.">–</span>,
  },
  {
    id: "ended",
    header: "Ended",
    cell: ({ finished_at }) => (finished_at ? <Time at={finished_at} /> : "–"),
  },
  { id: "actions", header: <span className="unseen">Actions</span>, cell: (job) => <JobActions job={job} /> },
];

const IDLE = (
  <>
    Jobs wait and none runs. If it stays so, start a worker where the service runs: <code>partwise work</code>
    .
  </>
);

/** What workers do and were asked to do, newest first. */
export function JobsPanel({
  collectionId,
  className,
}: {
  collectionId: number;
  className?: string | undefined;
}) {
  const jobs = useInfiniteQuery(jobsQuery(collectionId));
  const rows = jobs.data?.pages.flatMap((page) => page.items) ?? [];
  const isIdle = rows.some(isIn("pending")) && !rows.some(isIn("running"));
  return (
    <Panel
      title="Jobs"
      className={className}
      description={isIdle ? IDLE : undefined}
      actions={<StartJob collectionId={collectionId} />}
      isFlush
    >
      {jobs.error && !jobs.data ? (
        <PanelError what="Jobs" error={jobs.error} onRetry={jobs.refetch} />
      ) : (
        <DataTable
          caption="Jobs"
          columns={COLUMNS}
          rows={rows}
          keyOf={(job) => job.id}
          empty={
            jobs.isPending
              ? "Reading…"
              : "Nothing has been asked for yet. Jobs begin by themselves as people confirm labels."
          }
          isBusy={jobs.isPending}
        />
      )}
      <LoadMore pages={jobs} />
    </Panel>
  );
}

function isIn(state: Job["state"]) {
  return (job: Job) => job.state === state;
}
