import { useQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import type { Schemas } from "../../../api/client";
import { type Column, DataTable, Panel, Time } from "../../../components";
import { percent, whole } from "../../../components/numbers";
import { durationInWords } from "../../../components/timeInWords";
import { Chart } from "../charts/Chart";
import type { ChartData } from "../charts/chartData";
import { PanelError } from "../PanelError";
import { type Ops, roundsQuery } from "../queries";
import styles from "./RoundsPanel.module.css";
import { scoreName } from "./scoreNames";

type Round = Schemas["RoundOut"];
type Row = Round & { share: number | null };

interface RoundsPanelProps {
  collectionId: number;
  ops: Ops | undefined;
  className?: string | undefined;
}

/** Model by model: what it took, how unsure it was, how right people were meanwhile, and how much is scored by it. */
export function RoundsPanel({ collectionId, ops, className }: RoundsPanelProps) {
  const rounds = useQuery(roundsQuery(collectionId));
  const score = scoreName(rounds.data?.score_name ?? "");
  const chart = useMemo(() => roundsChart(rounds.data?.items ?? [], score), [rounds.data, score]);
  const shares = new Map((ops?.freshness ?? []).map((row) => [row.model_version, row.share]));
  const rows = (rounds.data?.items ?? []).map((round) => ({
    ...round,
    share: shares.get(round.model_version) ?? null,
  }));
  return (
    <Panel
      title="Rounds"
      className={className}
      description="A round is a model and the time until the next. Fresh is the share of scored shapes whose newest score is of that model."
      isFlush
    >
      {rounds.error && !rounds.data ? (
        <PanelError what="Rounds" error={rounds.error} onRetry={rounds.refetch} />
      ) : (
        <div className={styles.halves}>
          <DataTable
            caption="Rounds"
            columns={columnsOf(score)}
            rows={rows}
            keyOf={(round) => round.model_version}
            empty={rounds.isPending ? "Reading…" : "No model has been trained yet."}
          />
          <div className={styles.chart}>
            <Chart label="By model version" data={chart} wait="The lines begin with the second model." />
          </div>
        </div>
      )}
    </Panel>
  );
}

function columnsOf(score: string): readonly Column<Row>[] {
  return [
    { id: "version", header: "Model", cell: ({ model_version }) => `Version ${model_version}` },
    { id: "at", header: "Trained", cell: ({ trained_at }) => <Time at={trained_at} /> },
    {
      id: "took",
      header: "Took",
      isNumber: true,
      cell: ({ training_s }) => (training_s === null ? "–" : durationInWords(training_s)),
    },
    { id: "shapes", header: "On shapes", isNumber: true, cell: ({ n_shapes }) => whole(n_shapes) },
    {
      id: "score",
      header: `Mean ${score}`,
      isNumber: true,
      cell: ({ mean_score, n_scored }) =>
        mean_score === null ? (
          "–"
        ) : (
          <span title={`Over ${whole(n_scored)} shapes.`}>{mean_score.toFixed(3)}</span>
        ),
    },
    {
      id: "accuracy",
      header: "Blind accuracy",
      isNumber: true,
      cell: ({ blind_accuracy, n_checks }) =>
        blind_accuracy === null ? "–" : `${percent(blind_accuracy)} of ${whole(n_checks)}`,
    },
    {
      id: "fresh",
      header: "Fresh",
      isNumber: true,
      cell: ({ share }) => (share === null ? "–" : percent(share)),
    },
  ];
}

function roundsChart(newestFirst: readonly Round[], score: string): ChartData {
  const rounds = newestFirst.toReversed();
  return {
    x: rounds.map((round) => round.model_version),
    lines: [
      { name: `Mean ${score}`, values: rounds.map((round) => round.mean_score) },
      { name: "Blind accuracy", values: rounds.map((round) => round.blind_accuracy) },
    ],
    top: 1,
    isTime: false,
    format: (value) => value.toFixed(2),
  };
}
