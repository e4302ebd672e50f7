import { type RefObject, useEffect, useRef, useState } from "react";
import type { ChartData } from "./chartData";
import type { LineChart } from "./LineChart";

/**
 * Draws data in an element. The library comes with the first chart. Returns whether it refused to: it does where
 * the browser's language is one that the browser itself does not know.
 */
export function useLineChart(place: RefObject<HTMLElement | null>, data: ChartData): boolean {
  const chart = useRef<LineChart | null>(null);
  const latest = useRef(data);
  const [isRefused, setRefused] = useState(false);
  useEffect(() => {
    let isGone = false;
    const draw = async () => {
      const { LineChart } = await import("./LineChart");
      if (isGone || !place.current) return;
      chart.current = new LineChart(place.current);
      chart.current.connect();
      chart.current.show(latest.current);
    };
    draw().catch(() => setRefused(true));
    return () => {
      isGone = true;
      chart.current?.disconnect();
      chart.current = null;
    };
  }, [place]);
  useEffect(() => {
    latest.current = data;
    chart.current?.show(data);
  }, [data]);
  return isRefused;
}
