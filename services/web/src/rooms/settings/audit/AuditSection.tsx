import { useInfiniteQuery } from "@tanstack/react-query";
import { api, body, type Schemas } from "../../../api/client";
import { type Column, DataTable, Notice, Panel, Time } from "../../../components";
import { LoadMore } from "../../operations/LoadMore";

type Entry = Schemas["AuditOut"];

const COLUMNS: readonly Column<Entry>[] = [
  { id: "at", header: "When", cell: ({ at }) => <Time at={at} form="exact" /> },
  { id: "actor", header: "Who", cell: ({ actor }) => actor },
  { id: "action", header: "Did", cell: ({ action }) => action },
  { id: "subject", header: "To", cell: ({ subject }) => subject },
  { id: "detail", header: "Details", isWide: true, cell: ({ detail }) => <Detail detail={detail} /> },
];

/** Who did what, newest first, as it was recorded. */
export function AuditSection() {
  const audit = useInfiniteQuery({
    queryKey: ["audit"],
    queryFn: ({ pageParam }) =>
      body(
        api.GET("/api/v1/audit", {
          params: { query: { limit: 100, ...(pageParam && { before: pageParam }) } },
        }),
      ),
    initialPageParam: 0,
    getNextPageParam: (page) => (page.next ? Number(page.next) : undefined),
  });
  return (
    <Panel
      title="Audit trail"
      description="What operators and administrators did, newest first. It cannot be changed."
      isFlush
    >
      {audit.error && !audit.data ? (
        <Notice kind="error" title="The audit trail could not be read">
          {audit.error.message}
        </Notice>
      ) : (
        <DataTable
          caption="Audit trail"
          columns={COLUMNS}
          rows={audit.data?.pages.flatMap((page) => page.items) ?? []}
          keyOf={(entry) => entry.id}
          empty={audit.isPending ? "Reading…" : "Nothing has been recorded yet."}
        />
      )}
      <LoadMore pages={audit} />
    </Panel>
  );
}

function Detail({ detail }: { detail: Entry["detail"] }) {
  const words = Object.entries(detail)
    .filter(([, value]) => value !== null)
    .map(
      ([name, value]) =>
        `${name.replaceAll("_", " ")} ${typeof value === "string" ? value : JSON.stringify(value)}`,
    )
    .join(", ");
  return <span title={words}>{words}</span>;
}
