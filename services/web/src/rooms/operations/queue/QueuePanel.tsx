import { useMemo } from "react";
import { Panel, Skeleton } from "../../../components";
import { whole } from "../../../components/numbers";
import { Chart } from "../charts/Chart";
import type { ChartData } from "../charts/chartData";
import type { Sample } from "../history";
import type { Ops } from "../queries";

/** How deep the queue is, and how that went. */
export function QueuePanel({ ops, history }: { ops: Ops | undefined; history: readonly Sample[] }) {
  const chart = useMemo<ChartData>(
    () => ({
      x: history.map((sample) => sample.atS),
      lines: [
        { name: "Waiting", values: history.map((sample) => sample.free) },
        { name: "In hands", values: history.map((sample) => sample.held) },
      ],
      top: 5,
      isTime: true,
      format: whole,
    }),
    [history],
  );
  return (
    <Panel title="Queue" description="Labels that shapes still want, and those that somebody is at.">
      {ops ? (
        <Chart label="Depth of the queue" data={chart} wait="The line begins with the next figures." />
      ) : (
        <Skeleton height={168} />
      )}
    </Panel>
  );
}
