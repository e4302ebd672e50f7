import { useMutation, useQueryClient } from "@tanstack/react-query";
import { ChevronDown } from "lucide-react";
import { Link } from "wouter";
import { api, body, type Schemas } from "../../../api/client";
import { roomAddress } from "../../../app/roomAddress";
import { JOB_WORDS } from "../../../app/shell/jobWords";
import { Menu, MenuItem, useToast } from "../../../components";
import styles from "./StartJob.module.css";

type Kind = Schemas["NewJob"]["kind"];

const KINDS: readonly Kind[] = ["preprocess", "train", "evaluate", "refine", "select"];

/** Asks for a job now. Exports have choices, which the settings room offers. */
export function StartJob({ collectionId }: { collectionId: number }) {
  const queries = useQueryClient();
  const toast = useToast();
  const start = useMutation({
    mutationFn: (kind: Kind) =>
      body(
        api.POST("/api/v1/collections/{collection_id}/jobs", {
          params: { path: { collection_id: collectionId } },
          body: { kind, parameters: {} },
        }),
      ),
    onSuccess: (job) =>
      toast({ message: `${JOB_WORDS[job.kind].name}: asked for. A worker takes it when one is free.` }),
    onError: (error) => toast({ message: error.message, tone: "bad" }),
    onSettled: () => queries.invalidateQueries({ queryKey: ["jobs", collectionId] }),
  });
  const trigger = (
    <>
      Start a job <ChevronDown aria-hidden="true" />
    </>
  );
  return (
    <>
      <Link href={`${roomAddress(collectionId, "settings")}/export`} className={styles.link}>
        Export labels
      </Link>
      <Menu label="Start a job" trigger={trigger} alignment="end" variant="framed">
        {KINDS.map((kind) => (
          <MenuItem key={kind} onSelect={() => start.mutate(kind)}>
            <span title={JOB_WORDS[kind].meaning}>{JOB_WORDS[kind].name}</span>
          </MenuItem>
        ))}
      </Menu>
    </>
  );
}
