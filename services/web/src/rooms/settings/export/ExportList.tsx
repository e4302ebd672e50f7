import type { UseQueryResult } from "@tanstack/react-query";
import type { Schemas } from "../../../api/client";
import { type Column, DataTable, Notice, Panel, Time } from "../../../components";
import { JobActions } from "../../operations/jobs/JobActions";
import { JobStanding } from "../../operations/jobs/JobStanding";
import { FORMATS, MESHES, SEGMENTATIONS, wordsOf } from "./exportWords";

type Job = Schemas["JobOut"];

const COLUMNS: readonly Column<Job>[] = [
  {
    id: "what",
    header: "Export",
    cell: ({ parameters: { segmentation, format, on } }) => (
      <span title={wordsOf(MESHES, on)}>
        {wordsOf(SEGMENTATIONS, segmentation)}, {wordsOf(FORMATS, format)}
      </span>
    ),
  },
  { id: "at", header: "Asked for", cell: ({ created_at }) => <Time at={created_at} /> },
  { id: "standing", header: "Standing", isWide: true, cell: (job) => <JobStanding job={job} /> },
  { id: "actions", header: <span className="unseen">Actions</span>, cell: (job) => <JobActions job={job} /> },
];

/** Exports that were asked for, newest first. The newest one's end is read out. */
export function ExportList({ exports, lastId }: { exports: UseQueryResult<Job[]>; lastId: number | null }) {
  const last = exports.data?.find((job) => job.id === lastId);
  return (
    <Panel title="Exports" isFlush>
      <p role="status" className="unseen">
        {last?.state === "done" && "The export is done and can be downloaded."}
        {last?.state === "failed" && `The export failed. ${last.message}`}
      </p>
      {exports.error && !exports.data ? (
        <Notice kind="error" title="The exports could not be read">
          {exports.error.message}
        </Notice>
      ) : (
        <DataTable
          caption="Exports"
          columns={COLUMNS}
          rows={exports.data ?? []}
          keyOf={(job) => job.id}
          empty={exports.isPending ? "Reading…" : "Nothing has been exported yet."}
        />
      )}
    </Panel>
  );
}
