/** Why labels wait, in words. */
import { count, percent } from "../components/numbers";
import { durationInWords } from "../components/timeInWords";
import type { AcceptBatch, Effort, Review } from "./reviewRequests";

export const REASON_WORDS: Readonly<Record<Review["reason"], { title: string; why: string }>> = {
  "map-back": {
    title: "Moved to another mesh",
    why: "The labels were moved to a new mesh of the shape, and too little of them survived the way.",
  },
  schema: {
    title: "Parts have changed",
    why: "They were made under a version of the parts that has changed since.",
  },
  check: { title: "To be checked", why: "Everything that is confirmed here is looked at by a reviewer." },
  disagreement: {
    title: "People disagree",
    why: "Several people labelled the shape, and too differently. These labels are the closest to the others.",
  },
  rework: { title: "Sent back", why: "They were sent back; better ones are awaited." },
};

/** What a review says besides its reason: a note, or how much survived. */
export function detailWords({ detail }: Review): string | null {
  if (typeof detail.note === "string" && detail.note !== "") return `“${detail.note}”`;
  if (typeof detail.agreement === "number") return `${percent(detail.agreement)} of the area agrees.`;
  return null;
}

/** "2 min 10 s of work, 14 clicks"; null where nobody noted it. */
export function effortWords(effort: Effort | null): string | null {
  if (effort === null) return null;
  return `${workInWords(effort.active_s)} of work, ${count(effort.n_clicks, "click")}`;
}

/** To the second up to an hour: what is compared are minutes. */
function workInWords(seconds: number): string {
  const rest = Math.floor(seconds % 60);
  const words = durationInWords(seconds);
  return seconds >= 60 && seconds < 3600 && rest > 0 ? `${words} ${rest} s` : words;
}

/** "2 of 9 wrong: 22.2% (6.3% to 54.7%)", or that nobody knows yet. */
export function falseAcceptWords(batch: AcceptBatch): string {
  const { n_rechecks, n_rechecked, n_false, false_accept_rate, interval } = batch;
  if (n_rechecks === 0) return "No blind check was asked for.";
  if (false_accept_rate === null || interval === null) {
    return `Not known yet: ${count(n_rechecks, "shape")} ${n_rechecks === 1 ? "waits" : "wait"} for a blind check.`;
  }
  const [low, high] = interval;
  const range = `${percent(low ?? 0)} to ${percent(high ?? 1)}`;
  const soFar = n_rechecked < n_rechecks ? ` So far; ${n_rechecks - n_rechecked} still wait.` : "";
  return `${percent(false_accept_rate)} wrong (95% interval ${range}): ${n_false} of ${n_rechecked} checked.${soFar}`;
}
