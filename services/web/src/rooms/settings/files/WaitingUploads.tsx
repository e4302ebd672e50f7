import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api } from "../../../api/client";
import type { Upload } from "../../../api/upload";
import { Button, type Column, DataTable, Panel, Time, useToast } from "../../../components";
import { bytes } from "../../../components/numbers";
import { type Ingest, ingestsQuery, uploadsQuery } from "./queries";
import { useIngest } from "./useIngest";

/** Uploads that no job is about to take in, such as when asking for one failed. None: nothing is shown. */
export function WaitingUploads({ collectionId }: { collectionId: number }) {
  const uploads = useQuery(uploadsQuery(collectionId));
  const ingests = useQuery(ingestsQuery(collectionId));
  const asked = new Set(ingests.data?.filter(isUnderWay).map((job) => job.parameters.upload_id));
  const rows = ingests.data
    ? (uploads.data?.items ?? []).filter((upload) => !asked.has(upload.upload_id))
    : [];
  const columns: readonly Column<Upload>[] = [
    { id: "name", header: "File", isWide: true, cell: ({ name }) => <span title={name}>{name}</span> },
    { id: "size", header: "Size", isNumber: true, cell: ({ n_bytes }) => bytes(n_bytes) },
    { id: "person", header: "Sent by", cell: ({ person }) => person },
    { id: "expires", header: "Deleted", cell: ({ expires_at }) => <Time at={expires_at} /> },
    {
      id: "actions",
      header: <span className="unseen">Actions</span>,
      cell: (upload) => <UploadActions collectionId={collectionId} upload={upload} />,
    },
  ];
  if (rows.length === 0) return null;
  return (
    <Panel
      title="Waiting uploads"
      description="They are on the service, and nobody has asked for them to be taken in, or it failed. They are deleted when their time is up."
      isFlush
    >
      <DataTable
        caption="Waiting uploads"
        columns={columns}
        rows={rows}
        keyOf={(row) => row.upload_id}
        empty=""
      />
    </Panel>
  );
}

function isUnderWay({ state }: Ingest): boolean {
  return state === "pending" || state === "running";
}

function UploadActions({ collectionId, upload }: { collectionId: number; upload: Upload }) {
  const queries = useQueryClient();
  const toast = useToast();
  const ingest = useIngest(collectionId);
  const removal = useMutation({
    mutationFn: () =>
      api.DELETE("/api/v1/collections/{collection_id}/uploads/{upload_id}", {
        params: { path: { collection_id: collectionId, upload_id: upload.upload_id } },
      }),
    onError: (error) => toast({ message: error.message, tone: "bad" }),
    onSettled: () => queries.invalidateQueries({ queryKey: ["uploads", collectionId] }),
  });
  return (
    <>
      <Button
        size="small"
        aria-label={`Take ${upload.name} in`}
        isBusy={ingest.isPending}
        onClick={() =>
          ingest.mutate(
            { upload_id: upload.upload_id },
            {
              onSuccess: () => toast({ message: `${upload.name} is taken in as soon as a worker is free.` }),
            },
          )
        }
      >
        Take in
      </Button>{" "}
      <Button
        size="small"
        variant="quiet"
        aria-label={`Delete ${upload.name}`}
        isBusy={removal.isPending}
        onClick={() => removal.mutate()}
      >
        Delete
      </Button>
    </>
  );
}
