import { useInfiniteQuery, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { api } from "../../../api/client";
import { Badge, Button, type Column, DataTable, Dialog, Panel, Time, useToast } from "../../../components";
import { LoadMore } from "../LoadMore";
import { PanelError } from "../PanelError";
import { type Lease, leasesQuery, peopleQuery } from "../queries";

/** Who holds what, since when and until when; what nobody renews can be taken away. */
export function LeasesPanel({ collectionId }: { collectionId: number }) {
  const leases = useInfiniteQuery(leasesQuery(collectionId));
  const people = useQuery(peopleQuery);
  const [clearing, setClearing] = useState<Lease | null>(null);
  const nameOf = (id: number) =>
    people.data?.items.find((person) => person.id === id)?.name ?? `Person ${id}`;
  const columns: readonly Column<Lease>[] = [
    {
      id: "shape",
      header: "Shape",
      isWide: true,
      cell: ({ source_key }) => <span title={source_key}>{source_key}</span>,
    },
    { id: "person", header: "Person", cell: (lease) => nameOf(lease.person_id) },
    { id: "since", header: "Since", cell: (lease) => <Time at={lease.acquired_at} /> },
    { id: "expires", header: "Ends", cell: (lease) => <Ending lease={lease} /> },
    {
      id: "clear",
      header: <span className="unseen">Actions</span>,
      cell: (lease) => (
        <Button size="small" aria-label={`Take ${lease.source_key} away`} onClick={() => setClearing(lease)}>
          Take away
        </Button>
      ),
    },
  ];
  return (
    <Panel
      title="In hands"
      description="Shapes that people hold. Without a sign of life they are free again."
      isFlush
    >
      {leases.error && !leases.data ? (
        <PanelError what="Leases" error={leases.error} onRetry={leases.refetch} />
      ) : (
        <DataTable
          caption="Leases"
          columns={columns}
          rows={leases.data?.pages.flatMap((page) => page.items) ?? []}
          keyOf={(lease) => lease.id}
          empty={leases.isPending ? "Reading…" : "Nobody holds a shape."}
          isBusy={leases.isPending}
        />
      )}
      <LoadMore pages={leases} />
      {clearing && (
        <ClearDialog lease={clearing} name={nameOf(clearing.person_id)} onClose={() => setClearing(null)} />
      )}
    </Panel>
  );
}

function Ending({ lease }: { lease: Lease }) {
  if (Date.parse(lease.expires_at) < Date.now()) return <Badge tone="warning">Run out</Badge>;
  if (lease.is_prefetched) return <Badge title="Loaded ahead of the work on it.">Loaded ahead</Badge>;
  return <Time at={lease.expires_at} />;
}

function ClearDialog({ lease, name, onClose }: { lease: Lease; name: string; onClose: () => void }) {
  const queries = useQueryClient();
  const toast = useToast();
  const clearing = useMutation({
    mutationFn: () =>
      api.POST("/api/v1/leases/{lease_id}/clear", { params: { path: { lease_id: lease.id } } }),
    onSuccess: () => toast({ message: `${lease.source_key} is free again.`, tone: "good" }),
    onError: (error) => toast({ message: error.message, tone: "bad" }),
    onSettled: () => {
      void queries.invalidateQueries({ queryKey: ["leases", lease.collection_id] });
      onClose();
    },
  });
  return (
    <Dialog
      title="Take the shape away?"
      size="small"
      isAlert
      onClose={onClose}
      footer={
        <>
          <Button onClick={onClose}>Leave it</Button>
          <Button variant="danger" isBusy={clearing.isPending} onClick={() => clearing.mutate()}>
            Take away
          </Button>
        </>
      }
    >
      <p>
        {name} may be working on {lease.source_key}. Their draft stays, and they can go on with it if they get
        the shape again; until then anybody may claim it.
      </p>
    </Dialog>
  );
}
