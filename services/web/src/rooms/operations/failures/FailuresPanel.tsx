import { useInfiniteQuery } from "@tanstack/react-query";
import { RotateCcw } from "lucide-react";
import { useState } from "react";
import { Button, DataTable, Panel } from "../../../components";
import { whole } from "../../../components/numbers";
import { LoadMore } from "../LoadMore";
import { PanelError } from "../PanelError";
import { type Failure, type FailureFilter, failuresQuery, type Ops } from "../queries";
import { FailureDialog } from "./FailureDialog";
import { FailureFilters } from "./FailureFilters";
import { FailureKinds } from "./FailureKinds";
import { failureColumns } from "./failureColumns";
import { useRetryFailures } from "./useRetryFailures";

interface FailuresPanelProps {
  collectionId: number;
  ops: Ops | undefined;
  className?: string | undefined;
}

/** Shapes that a stage gave up: why, with their logs, and trying them again. */
export function FailuresPanel({ collectionId, ops, className }: FailuresPanelProps) {
  const [filter, setFilter] = useState<FailureFilter>({ kind: null, stage: null });
  const [chosen, setChosen] = useState<ReadonlySet<number>>(new Set());
  const [shown, setShown] = useState<Failure | null>(null);
  const failures = useInfiniteQuery(failuresQuery(collectionId, filter));
  const retry = useRetryFailures(collectionId, () => setChosen(new Set()));
  const rows = failures.data?.pages.flatMap((page) => page.items) ?? [];
  const choose = (shapeIds: readonly number[], isChosen: boolean) =>
    setChosen(
      (before) =>
        new Set(isChosen ? [...before, ...shapeIds] : [...before].filter((id) => !shapeIds.includes(id))),
    );
  const change = (part: Partial<FailureFilter>) => {
    setChosen(new Set());
    setFilter({ ...filter, ...part });
  };
  const isFiltered = filter.kind !== null || filter.stage !== null;
  return (
    <Panel
      title="Failures"
      className={className}
      isFlush
      description="Shapes that a stage gave up after a few tries. The rest of the collection goes on without them."
      actions={
        <>
          <FailureFilters ops={ops} filter={filter} onChange={change} />
          <Button
            size="small"
            icon={<RotateCcw />}
            disabled={rows.length === 0}
            isBusy={retry.isPending}
            onClick={() =>
              retry.mutate(chosen.size > 0 ? { shape_ids: [...chosen], ...present(filter) } : present(filter))
            }
          >
            {chosen.size > 0
              ? `Try ${whole(chosen.size)} again`
              : isFiltered
                ? "Try these again"
                : "Try all again"}
          </Button>
        </>
      }
    >
      {ops && <FailureKinds ops={ops} />}
      {failures.error && !failures.data ? (
        <PanelError what="Failures" error={failures.error} onRetry={failures.refetch} />
      ) : (
        <DataTable
          caption="Failures"
          columns={failureColumns({ rows, chosen, choose, onShow: setShown })}
          rows={rows}
          keyOf={({ shape_id, stage }) => `${shape_id} ${stage}`}
          empty={
            failures.isPending ? "Reading…" : isFiltered ? "No failures like this." : "Nothing has failed."
          }
          isBusy={failures.isPending}
        />
      )}
      <LoadMore pages={failures} />
      {shown && (
        <FailureDialog
          failure={shown}
          isRetrying={retry.isPending}
          onRetry={() =>
            retry.mutate(
              { shape_ids: [shown.shape_id], stage: shown.stage },
              { onSettled: () => setShown(null) },
            )
          }
          onClose={() => setShown(null)}
        />
      )}
    </Panel>
  );
}

function present({ kind, stage }: FailureFilter) {
  return { ...(kind && { kind }), ...(stage && { stage }) };
}
