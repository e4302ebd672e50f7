import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import type { Schemas } from "../../../api/client";
import { type Column, DataTable, Panel, Select, Time } from "../../../components";
import { decimal, percent, whole } from "../../../components/numbers";
import { durationInWords } from "../../../components/timeInWords";
import { PanelError } from "../PanelError";
import { peopleOpsQuery } from "../queries";

type Person = Schemas["PersonOps"];

const TERMS = [
  { value: "1", label: "Last day" },
  { value: "7", label: "Last week" },
  { value: "30", label: "Last 30 days" },
  { value: "365", label: "Last year" },
] as const;

const unknown = (why: string) => <span title={why}>–</span>;
const NO_TIMES = "Their strokes carry no times, as imported labels do not.";

const COLUMNS: readonly Column<Person>[] = [
  { id: "name", header: "Person", isWide: true, cell: ({ name }) => <span title={name}>{name}</span> },
  { id: "labels", header: "Labels", isNumber: true, cell: ({ labels }) => whole(labels) },
  {
    id: "active",
    header: "At work",
    isNumber: true,
    cell: ({ active_h }) => (active_h > 0 ? durationInWords(active_h * 3600) : unknown(NO_TIMES)),
  },
  {
    id: "pace",
    header: <span title="Labels an hour, without pauses">An hour</span>,
    isNumber: true,
    cell: ({ labels_per_h }) => (labels_per_h === null ? unknown(NO_TIMES) : decimal(labels_per_h)),
  },
  {
    id: "seconds",
    header: <span title="Time for a shape, without pauses">A shape</span>,
    isNumber: true,
    cell: ({ seconds_per_shape }) =>
      seconds_per_shape === null ? unknown(NO_TIMES) : `${decimal(seconds_per_shape)} s`,
  },
  {
    id: "clicks",
    header: "Clicks a shape",
    isNumber: true,
    cell: ({ clicks_per_shape }) =>
      clicks_per_shape === null ? unknown(NO_TIMES) : decimal(clicks_per_shape),
  },
  {
    id: "accuracy",
    header: "Blind accuracy",
    isNumber: true,
    cell: ({ blind_accuracy, n_checks }) =>
      blind_accuracy === null
        ? unknown("No blind check yet. Their share is set in the settings.")
        : `${percent(blind_accuracy)} of ${whole(n_checks)}`,
  },
  { id: "last", header: "Last label", cell: ({ last_at }) => <Time at={last_at} /> },
];

/** How much people label, how fast, and how right they are. */
export function PeoplePanel({
  collectionId,
  className,
}: {
  collectionId: number;
  className?: string | undefined;
}) {
  const [days, setDays] = useState<(typeof TERMS)[number]["value"]>("30");
  const people = useQuery(peopleOpsQuery(collectionId, Number(days)));
  return (
    <Panel
      title="People at work"
      className={className}
      description="Times leave out pauses. Blind accuracy is the share of the area that was right on shapes whose labels are known."
      actions={
        <Select label="Time" isLabelUnseen size="small" value={days} options={TERMS} onChange={setDays} />
      }
      isFlush
    >
      {people.error && !people.data ? (
        <PanelError what="People" error={people.error} onRetry={people.refetch} />
      ) : (
        <DataTable
          caption="People at work"
          columns={COLUMNS}
          rows={people.data?.items ?? []}
          keyOf={(person) => person.person_id}
          empty={people.isPending ? "Reading…" : "Nobody has confirmed labels in this time."}
        />
      )}
    </Panel>
  );
}
