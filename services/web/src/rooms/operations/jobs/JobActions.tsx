import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Download } from "lucide-react";
import { api } from "../../../api/client";
import { JOB_WORDS } from "../../../app/shell/jobWords";
import { Button, useToast } from "../../../components";
import type { Job } from "../queries";
import { downloadAddress } from "./downloadAddress";
import styles from "./JobActions.module.css";

/** What can be done about a job: stop it, ask for it again, fetch what it made. */
export function JobActions({ job }: { job: Job }) {
  const queries = useQueryClient();
  const toast = useToast();
  const path = { params: { path: { job_id: job.id } } };
  const options = {
    onError: (error: Error) => toast({ message: error.message, tone: "bad" }),
    onSettled: () => queries.invalidateQueries({ queryKey: ["jobs", job.collection_id] }),
  };
  const cancel = useMutation({
    mutationFn: () => api.POST("/api/v1/jobs/{job_id}/cancel", path),
    ...options,
  });
  const retry = useMutation({ mutationFn: () => api.POST("/api/v1/jobs/{job_id}/retry", path), ...options });
  const named = (what: string) => `${what}: ${JOB_WORDS[job.kind].name}, job ${job.id}`;
  if (job.state === "pending" || job.state === "running") {
    return (
      <Button
        size="small"
        aria-label={named("Cancel")}
        isBusy={cancel.isPending}
        disabled={job.cancel_requested}
        onClick={() => cancel.mutate()}
      >
        Cancel
      </Button>
    );
  }
  if (job.state === "done") {
    if (job.kind !== "export") return null;
    return (
      <a className={styles.download} href={downloadAddress(job.id)} download aria-label={named("Download")}>
        <Download aria-hidden="true" /> Download
      </a>
    );
  }
  return (
    <Button
      size="small"
      aria-label={named("Try again")}
      isBusy={retry.isPending}
      onClick={() => retry.mutate()}
    >
      Try again
    </Button>
  );
}
