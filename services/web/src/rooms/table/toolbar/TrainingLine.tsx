import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { runningJobsQuery } from "../../../api/queries";
import { useHasRole } from "../../../app/session/MeContext";
import { Button, Progress, Time, useToast } from "../../../components";
import { modelsQuery, startTraining, waitingJobsQuery } from "../rows/tableQueries";
import styles from "./Toolbar.module.css";
import { trainedOn, trainingJob, trainingShare, trainingWords } from "./trainingWords";

/** Which model the scores are from, where the next one is, and a button that asks for it. */
export function TrainingLine({ collectionId }: { collectionId: number }) {
  const mayTrain = useHasRole("reviewer");
  const model = useQuery(modelsQuery(collectionId)).data?.items[0];
  const running = useQuery(runningJobsQuery(collectionId)).data?.items ?? [];
  const waiting = useQuery(waitingJobsQuery(collectionId)).data?.items ?? [];
  const job = trainingJob([...running, ...waiting]);
  const share = job && trainingShare(job);
  return (
    <div className={styles.training} role="status" aria-label="Model">
      {job ? (
        <>
          <span>{trainingWords(job, model?.version ?? null)}</span>
          {job.state === "running" && (
            <Progress label="Training" value={share ?? undefined} className={styles.trainingBar ?? ""} />
          )}
        </>
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
      {mayTrain && job === null && <TrainNow collectionId={collectionId} />}
    </div>
  );
}

function TrainNow({ collectionId }: { collectionId: number }) {
  const client = useQueryClient();
  const showToast = useToast();
  const training = useMutation({
    mutationFn: () => startTraining(collectionId),
    onError: (error) => showToast({ message: error.message, tone: "bad" }),
    onSuccess: () => client.invalidateQueries({ queryKey: ["jobs", collectionId] }),
  });
  return (
    <Button size="small" isBusy={training.isPending} onClick={() => training.mutate()}>
      Train now
    </Button>
  );
}
