import { useInfiniteQuery } from "@tanstack/react-query";
import { Link } from "wouter";
import { type Column, DataTable, Panel, Time } from "../../../components";
import { type SkippedShape, skipsQuery } from "../../../reviews/skipsQuery";
import { workAddress } from "../../workbench/workAddress";
import { LoadMore } from "../LoadMore";
import { PanelError } from "../PanelError";

/** Shapes that people gave back for good, and why. */
export function SkipsPanel(props: { collectionId: number; className?: string | undefined }) {
  const { collectionId, className } = props;
  const skips = useInfiniteQuery(skipsQuery(collectionId));
  const columns: readonly Column<SkippedShape>[] = [
    {
      id: "shape",
      header: "Shape",
      cell: ({ shape_id, source_key }) => (
        <Link href={workAddress(collectionId, [shape_id])} title={source_key}>
          {source_key}
        </Link>
      ),
    },
    { id: "reason", header: "Why", isWide: true, cell: ({ reason }) => <span title={reason}>{reason}</span> },
    { id: "person", header: "Person", cell: ({ person_name }) => person_name },
    { id: "when", header: "When", cell: ({ skipped_at }) => <Time at={skipped_at} /> },
  ];
  return (
    <Panel
      title="Skipped"
      className={className}
      description="Shapes that somebody could not label. They go to others; the same reason again and again is a fault of the shapes or of the parts."
      isFlush
    >
      {skips.error && !skips.data ? (
        <PanelError what="Skipped shapes" error={skips.error} onRetry={skips.refetch} />
      ) : (
        <DataTable
          caption="Skipped shapes"
          columns={columns}
          rows={skips.data?.pages.flatMap((page) => page.items) ?? []}
          keyOf={(skip) => `${skip.shape_id} ${skip.person_id} ${skip.skipped_at}`}
          empty={skips.isPending ? "Reading…" : "Nothing was skipped."}
          isBusy={skips.isPending}
        />
      )}
      <LoadMore pages={skips} />
    </Panel>
  );
}
