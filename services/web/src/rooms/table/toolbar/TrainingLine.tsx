import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { runningJobsQuery } from "../../../api/queries";
import { useHasRole } from "../../../app/session/MeContext";
import { Button, classes, Progress, Time, useToast } from "../../../components";
import { opsQuery } from "../../operations/queries";
import { failedJobsQuery, modelsQuery, startTraining, waitingJobsQuery } from "../rows/tableQueries";
import styles from "./Toolbar.module.css";
import {
  failedTraining,
  failureWords,
  trainedOn,
  trainingJob,
  trainingShare,
  trainingWords,
} from "./trainingWords";

/** Which model the scores are from, where the next one is or why there is none, and a button that asks for it. */
export function TrainingLine({ collectionId }: { collectionId: number }) {
  const mayTrain = useHasRole("reviewer");
  const model = useQuery(modelsQuery(collectionId)).data?.items[0];
  const running = useQuery(runningJobsQuery(collectionId)).data?.items ?? [];
  const waiting = useQuery(waitingJobsQuery(collectionId)).data?.items ?? [];
  const failures = useQuery({ ...failedJobsQuery(collectionId), enabled: mayTrain }).data?.items ?? [];
  const version = model?.version ?? null;
  const job = trainingJob([...running, ...waiting]);
  const failed = job === null ? failedTraining(failures, model) : null;
  const share = job && trainingShare(job);
  return (
    <div className={classes(styles.training, failed && styles.failed)} role="status" aria-label="Model">
      {job ? (
        <>
          <span>
            {trainingWords(job, version)}
            {job.state === "pending" && <Waiting collectionId={collectionId} since={job.created_at} />}
          </span>
          {job.state === "running" && (
            <Progress label="Training" value={share ?? undefined} className={styles.trainingBar ?? ""} />
          )}
        </>
      ) : failed ? (
        <span>{failureWords(failed, version)}</span>
      ) : (
        <span>
          {model ? (
            <>
              Model {model.version}, {trainedOn(model)}, <Time at={model.trained_at} />
            </>
          ) : (
            "No model yet"
          )}
        </span>
      )}
      {mayTrain && job === null && (
        <TrainNow collectionId={collectionId} words={failed ? "Try again" : "Train now"} />
      )}
    </div>
  );
}

/** Since when a job waits; and whether it will for long, to those who are told of workers. */
function Waiting({ collectionId, since }: { collectionId: number; since: string }) {
  const isOperator = useHasRole("operator");
  const workers = useQuery({ ...opsQuery(collectionId), enabled: isOperator }).data?.workers;
  return (
    <>
      , asked for <Time at={since} />
      {workers?.length === 0 && <strong>: no worker is running</strong>}
    </>
  );
}

function TrainNow({ collectionId, words }: { collectionId: number; words: string }) {
  const client = useQueryClient();
  const showToast = useToast();
  const training = useMutation({
    mutationFn: () => startTraining(collectionId),
    onError: (error) => showToast({ message: error.message, tone: "bad" }),
    onSuccess: () => client.invalidateQueries({ queryKey: ["jobs", collectionId] }),
  });
  return (
    <Button size="small" isBusy={training.isPending} onClick={() => training.mutate()}>
      {words}
    </Button>
  );
}
