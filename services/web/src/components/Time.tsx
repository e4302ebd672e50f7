import { useEffect, useState } from "react";
import { ageInWords, exactTime } from "./timeInWords";

const TICK_MS = 15_000;

export interface TimeProps {
  /** ISO 8601, as the service tells times. */
  at: string;
  /** "relative": 3 min ago, kept true, exact on hover. "exact": date and time of day. */
  form?: "relative" | "exact";
}

export function Time({ at, form = "relative" }: TimeProps) {
  const [now, setNow] = useState(() => Date.now());
  useEffect(() => {
    if (form !== "relative") return undefined;
    const timer = window.setInterval(() => setNow(Date.now()), TICK_MS);
    return () => window.clearInterval(timer);
  }, [form]);
  const exact = exactTime(at);
  return (
    <time dateTime={at} title={exact}>
      {form === "exact" ? exact : ageInWords(Date.parse(at), now)}
    </time>
  );
}
