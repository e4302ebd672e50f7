import { JOB_WORDS } from "../../../app/shell/jobWords";
import { Badge, Progress, type Tone } from "../../../components";
import { count, whole } from "../../../components/numbers";
import type { Job } from "../queries";
import styles from "./JobStanding.module.css";

const STATES: Readonly<Record<Job["state"], { words: string; tone: Tone }>> = {
  pending: { words: "Waits", tone: "neutral" },
  running: { words: "Runs", tone: "accent" },
  done: { words: "Done", tone: "good" },
  failed: { words: "Failed", tone: "bad" },
  cancelled: { words: "Cancelled", tone: "warning" },
};

/** A job's state, how far it is, and the last that it said. */
export function JobStanding({ job }: { job: Job }) {
  const { words, tone } = STATES[job.state];
  const { done, failed, total } = job.progress;
  const isRunning = job.state === "running";
  const tried = job.attempts > 1 ? `try ${job.attempts}` : "";
  const said = [isRunning || job.state === "pending" ? "" : stepsOf(job), tried, job.message]
    .filter(Boolean)
    .join(" · ");
  return (
    <div className={styles.standing}>
      <Badge tone={tone}>{isRunning && job.cancel_requested ? "Stopping" : words}</Badge>
      {isRunning && (
        <>
          <Progress
            label={`${JOB_WORDS[job.kind].name}, done`}
            value={total === null ? undefined : done + failed}
            max={total ?? 1}
            className={styles.bar ?? ""}
          />
          <span className={styles.steps}>{stepsOf(job)}</span>
        </>
      )}
      <span className={styles.said} title={said}>
        {said}
      </span>
    </div>
  );
}

function stepsOf({ progress: { done, failed, total } }: Job): string {
  if (done === 0 && failed === 0 && !total) return "";
  const steps = total === null || total === done ? whole(done) : `${whole(done)} of ${whole(total)}`;
  return failed > 0 ? `${steps}, ${count(failed, "failure")}` : steps;
}
