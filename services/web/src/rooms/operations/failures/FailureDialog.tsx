import { useQuery } from "@tanstack/react-query";
import { Button, CopyButton, Dialog, Notice, Skeleton, Time } from "../../../components";
import { count } from "../../../components/numbers";
import { type Failure, shapeQuery } from "../queries";
import { stageName } from "../stageWords";
import styles from "./FailureDialog.module.css";
import { FAILURE_WORDS } from "./failureWords";

interface FailureDialogProps {
  failure: Failure;
  isRetrying: boolean;
  onRetry: () => void;
  onClose: () => void;
}

/** All that is on record of one failure: reason, tries, what had ended it before, and the end of its log. */
export function FailureDialog({ failure, isRetrying, onRetry, onClose }: FailureDialogProps) {
  const shape = useQuery(shapeQuery(failure.shape_id));
  const card = shape.data?.provenance.stages.find(
    (stage) => stage.stage === failure.stage && stage.failure,
  )?.failure;
  const log = card?.log.join("\n") ?? "";
  return (
    <Dialog
      title={failure.source_key}
      size="wide"
      onClose={onClose}
      footer={
        <>
          {log !== "" && <CopyButton text={`${failure.message}\n${log}`} label="Copy log" />}
          <Button onClick={onClose}>Close</Button>
          <Button variant="primary" isBusy={isRetrying} onClick={onRetry}>
            Try again
          </Button>
        </>
      }
    >
      <p>
        {stageName(failure.stage)} gave up after {count(failure.attempts, "try", "tries")},{" "}
        <Time at={failure.at} />. <strong>{FAILURE_WORDS[failure.kind].name}.</strong>{" "}
        {FAILURE_WORDS[failure.kind].advice}
      </p>
      <pre className={styles.reason}>{failure.message}</pre>
      {shape.isPending && <Skeleton height={120} />}
      {shape.error && (
        <Notice kind="error" title="The log could not be read">
          {shape.error.message}
        </Notice>
      )}
      {card && card.steps.length > 0 && (
        <ul className={styles.steps}>
          {card.steps.map(([step, why]) => (
            <li key={step}>
              Before: <strong>{step}</strong>, {why}
            </li>
          ))}
        </ul>
      )}
      {shape.data && (
        <section aria-label="End of the log">
          <h3 className={styles.heading}>End of the log</h3>
          <pre className={styles.log}>{log || "The stage wrote nothing before it failed."}</pre>
        </section>
      )}
    </Dialog>
  );
}
