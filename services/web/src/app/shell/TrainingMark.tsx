import { useQuery } from "@tanstack/react-query";
import type { Schemas } from "../../api/client";
import { runningJobsQuery } from "../../api/queries";
import { Progress } from "../../components";
import { count, whole } from "../../components/numbers";
import { JOB_WORDS } from "./jobWords";
import styles from "./TrainingMark.module.css";

type Job = Schemas["JobOut"];

/** What the machine is at: training and what follows it, with how far it is. Nothing while it rests. */
export function TrainingMark({ collectionId }: { collectionId: number }) {
  const jobs = useQuery(runningJobsQuery(collectionId));
  const job = foremost(jobs.data?.items ?? []);
  const words = job && JOB_WORDS[job.kind].doing;
  return (
    <div
      role="status"
      aria-label="Training"
      className={job ? styles.mark : "unseen"}
      title={job && detailOf(job)}
    >
      {job && words && (
        <>
          <span className={styles.words}>{words}</span>
          <Progress
            label={words}
            value={job.progress.total === null ? undefined : job.progress.done + job.progress.failed}
            max={job.progress.total ?? 1}
            className={styles.bar ?? ""}
          />
        </>
      )}
    </div>
  );
}

/** Training is what people wait for; else the one that was begun last. */
export function foremost(jobs: readonly Job[]): Job | undefined {
  return jobs.find((job) => job.kind === "train") ?? jobs[0];
}

function detailOf({ kind, progress: { done, failed, total, message } }: Job): string {
  const steps = total === null ? `${whole(done)} done` : `${whole(done)} of ${whole(total)} done`;
  const lost = failed > 0 ? `, ${count(failed, "failure")}` : "";
  return [`${JOB_WORDS[kind].doing}: ${steps}${lost}`, message].filter(Boolean).join(" · ");
}
