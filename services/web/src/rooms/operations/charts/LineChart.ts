import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { ChartData } from "./chartData";
import { DASHES, N_SERIES_COLOURS, resolvedColour } from "./seriesColours";

const HEIGHT_PX = 168;
/** One point makes no line, and no sensible axis. */
const MIN_POINTS = 2;
const Y_AXIS_PX = 52;
const MINUTE_S = 60;
const X_AXIS_PX = 28;
const CLOCK: Partial<uPlot.Axis> = { values: (_plot, times) => clockTimes(times), space: 90 };
const ROUND_BY_ROUND: Partial<uPlot.Axis> = { incrs: [1, 2, 5, 10, 20, 50, 100] };

/** A chart in an element: made when it is connected, drawn anew when its data, its width or the scheme changes. */
export class LineChart {
  private plot: uPlot | undefined;
  private data: ChartData | undefined;
  private readonly width = new ResizeObserver(() => this.fit());
  private readonly scheme = new MutationObserver(() => this.rebuild());
  private readonly systemScheme = matchMedia("(prefers-color-scheme: dark)");
  private readonly rebuild = () => this.build();

  constructor(private readonly element: HTMLElement) {}

  connect(): void {
    this.width.observe(this.element);
    this.scheme.observe(document.documentElement, { attributeFilter: ["data-scheme"] });
    this.systemScheme.addEventListener("change", this.rebuild);
  }

  disconnect(): void {
    this.width.disconnect();
    this.scheme.disconnect();
    this.systemScheme.removeEventListener("change", this.rebuild);
    this.plot?.destroy();
    this.plot = undefined;
  }

  show(data: ChartData): void {
    const isSame = this.data !== undefined && namesOf(this.data) === namesOf(data);
    this.data = data;
    if (isSame && this.plot) this.plot.setData(alignedData(data));
    else this.build();
  }

  private fit(): void {
    const width = this.element.clientWidth;
    if (width > 0) this.plot?.setSize({ width, height: HEIGHT_PX });
  }

  private build(): void {
    this.plot?.destroy();
    this.plot = undefined;
    if (!this.data || this.data.x.length < MIN_POINTS) return;
    this.plot = new uPlot(this.options(this.data), alignedData(this.data), this.element);
  }

  private options(data: ChartData): uPlot.Options {
    const colour = (token: string) => resolvedColour(token, this.element);
    const axis = {
      stroke: colour("--text-muted"),
      grid: { stroke: colour("--border"), width: 1 },
      ticks: { show: false },
    };
    const font = `11px ${getComputedStyle(this.element).fontFamily}`;
    return {
      width: Math.max(this.element.clientWidth, 1),
      height: HEIGHT_PX,
      legend: { show: false }, // the page has one of its own, with the latest values
      cursor: { y: false, points: { size: 6 } },
      scales: {
        x: { time: data.isTime },
        y: { range: (_plot, _low, high) => [0, Math.max(data.top ?? 0, (high ?? 0) * 1.08, Number.EPSILON)] },
      },
      axes: [
        { ...axis, font, grid: { show: false }, size: X_AXIS_PX, ...(data.isTime ? CLOCK : ROUND_BY_ROUND) },
        { ...axis, font, size: Y_AXIS_PX, values: (_plot, splits) => splits.map(data.format) },
      ],
      series: [
        {},
        ...data.lines.map((line, index) => ({
          label: line.name,
          stroke: colour(`--series-${(index % N_SERIES_COLOURS) + 1}`),
          width: 2,
          dash: [...(DASHES[index % DASHES.length] ?? [])],
          points: { show: !data.isTime, size: 6 },
          spanGaps: true,
        })),
      ],
    };
  }
}

/** Times of day, with seconds where the marks are closer than a minute. */
function clockTimes(timesS: readonly number[]): string[] {
  const [first = 0, second = first + MINUTE_S] = timesS;
  const format: Intl.DateTimeFormatOptions = { hour: "2-digit", minute: "2-digit" };
  if (second - first < MINUTE_S) format.second = "2-digit";
  return timesS.map((atS) => new Date(atS * 1000).toLocaleTimeString(undefined, format));
}

function namesOf(data: ChartData): string {
  return data.lines.map((line) => line.name).join("\n");
}

function alignedData(data: ChartData): uPlot.AlignedData {
  return [[...data.x], ...data.lines.map((line) => [...line.values])];
}
