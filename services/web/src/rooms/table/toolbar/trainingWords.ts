/** Where training is, in a line. */
import type { Schemas } from "../../../api/client";
import { count } from "../../../components/numbers";

type Job = Schemas["JobOut"];

/** The work that makes the next model and its scores, in the order in which it is done. */
const WORK: readonly Job["kind"][] = ["train", "evaluate", "refine"];

/** What goes on now: the running one first, then one that waits. Null if nothing does. */
export function trainingJob(jobs: readonly Job[]): Job | null {
  for (const state of ["running", "pending"] as const) {
    for (const kind of WORK) {
      const found = jobs.find((job) => job.kind === kind && job.state === state);
      if (found) return found;
    }
  }
  return null;
}

/** The newest training, if it failed and no model has come of another since. jobs : that failed, newest first. */
export function failedTraining(jobs: readonly Job[], model: Schemas["ModelOut"] | undefined): Job | null {
  const failed = jobs.find((job) => job.kind === "train");
  if (failed === undefined || failed.finished_at === null) return null;
  const isOld = model !== undefined && Date.parse(model.trained_at) > Date.parse(failed.finished_at);
  return isOld ? null : failed;
}

/** "Model 4 could not be trained: …". version : of the newest model; null before the first. */
export function failureWords({ message }: Job, version: number | null): string {
  const words = `Model ${(version ?? 0) + 1} could not be trained`;
  return message === "" ? words : `${words}: ${message}`;
}

/** "Model 4 is being trained: 62 %". `version`: of the newest model; null before the first. */
export function trainingWords(job: Job, version: number | null): string {
  const next = job.kind === "train" ? (version ?? 0) + 1 : (version ?? 1);
  if (job.state === "pending") {
    return job.kind === "train" ? `Model ${next} waits to be trained` : `Model ${next} waits to score shapes`;
  }
  const doing = {
    train: "is being trained",
    evaluate: "is scoring shapes",
    refine: "is refining its predictions",
  };
  const words = `Model ${next} ${doing[job.kind as keyof typeof doing]}`;
  const share = trainingShare(job);
  return share === null ? words : `${words}: ${Math.floor(share * 100)} %`;
}

/** In [0, 1]; null while nobody knows. */
export function trainingShare({ progress: { done, failed, total } }: Job): number | null {
  return total === null || total === 0 ? null : Math.min(1, (done + failed) / total);
}

/** "trained on 120 shapes" */
export function trainedOn(model: Schemas["ModelOut"]): string {
  return `trained on ${count(model.n_shapes, "shape")}`;
}
