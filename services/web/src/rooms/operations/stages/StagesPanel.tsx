import { useMemo } from "react";
import { type Column, DataTable, Panel, Progress, Skeleton } from "../../../components";
import { decimal, whole } from "../../../components/numbers";
import { durationInWords } from "../../../components/timeInWords";
import { Chart } from "../charts/Chart";
import type { ChartData } from "../charts/chartData";
import type { Sample } from "../history";
import type { Ops } from "../queries";
import { stageMeaning, stageName } from "../stageWords";
import styles from "./StagesPanel.module.css";

type Stage = Ops["stages"][number];

interface StagesPanelProps {
  ops: Ops | undefined;
  history: readonly Sample[];
  className?: string | undefined;
}

/** Each stage's progress, pace and end, and how the pace went. */
export function StagesPanel({ ops, history, className }: StagesPanelProps) {
  const chart = useMemo(() => paceChart(ops, history), [ops, history]);
  return (
    <Panel
      title="Stages"
      className={className}
      description={ops && `Pace is what was done a minute over the last ${whole(ops.window_min)} minutes.`}
      isFlush
    >
      {ops ? (
        <div className={styles.halves}>
          <DataTable
            caption="Stages"
            columns={COLUMNS}
            rows={ops.stages}
            keyOf={(stage) => stage.stage}
            empty="Nothing has run yet. Add files in the settings; stages begin by themselves."
          />
          <div className={styles.chart}>
            <Chart
              label="Shapes a minute by stage"
              data={chart}
              wait="The line begins with the next figures."
            />
          </div>
        </div>
      ) : (
        <Skeleton height={220} />
      )}
    </Panel>
  );
}

const COLUMNS: readonly Column<Stage>[] = [
  {
    id: "stage",
    header: "Stage",
    cell: ({ stage }) => <span title={stageMeaning(stage)}>{stageName(stage)}</span>,
  },
  {
    id: "progress",
    header: "Progress",
    isWide: true,
    cell: ({ stage, done, remaining }) => (
      <Progress label={`${stageName(stage)}, done`} value={done} max={done + remaining} />
    ),
  },
  { id: "done", header: "Done", isNumber: true, cell: ({ done }) => whole(done) },
  { id: "remaining", header: "Waiting", isNumber: true, cell: ({ remaining }) => whole(remaining) },
  {
    id: "failed",
    header: "Failed",
    isNumber: true,
    cell: ({ failed }) => <span className={failed > 0 ? styles.failed : undefined}>{whole(failed)}</span>,
  },
  { id: "pace", header: "A minute", isNumber: true, cell: ({ per_min }) => paceInWords(per_min) },
  {
    id: "eta",
    header: "Time left",
    isNumber: true,
    cell: ({ remaining, eta_s }) => {
      if (remaining === 0) return "done";
      return eta_s === null ? <span title="Nothing was done lately.">–</span> : durationInWords(eta_s);
    },
  },
];

/** Slow stages do less than one shape a minute. */
function paceInWords(perMin: number): string {
  return perMin > 0 && perMin < 1 ? perMin.toFixed(2) : decimal(perMin);
}

function paceChart(ops: Ops | undefined, history: readonly Sample[]): ChartData {
  return {
    x: history.map((sample) => sample.atS),
    lines: (ops?.stages ?? []).map(({ stage }) => ({
      name: stageName(stage),
      values: history.map((sample) => sample.perMin[stage] ?? null),
    })),
    top: 1,
    isTime: true,
    format: paceInWords,
  };
}
