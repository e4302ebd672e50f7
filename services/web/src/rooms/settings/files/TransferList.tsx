import { Badge, Button, Progress, type Tone } from "../../../components";
import { bytes } from "../../../components/numbers";
import styles from "./TransferList.module.css";
import { isUnderWay, type Transfer } from "./transfers";

const STATES: Readonly<Record<Transfer["state"], { words: string; tone: Tone }>> = {
  waiting: { words: "Waits", tone: "neutral" },
  sending: { words: "Sending", tone: "accent" },
  sent: { words: "Sent", tone: "good" },
  failed: { words: "Failed", tone: "bad" },
  cancelled: { words: "Cancelled", tone: "neutral" },
};

interface TransferListProps {
  transfers: readonly Transfer[];
  onCancel: (id: number) => void;
  onClear: () => void;
}

/** Files on their way, and those that are there. */
export function TransferList({ transfers, onCancel, onClear }: TransferListProps) {
  const nSent = transfers.filter((each) => each.state === "sent").length;
  return (
    <section aria-label="Files on their way">
      <div className={styles.head} role="status">
        {nSent} of {transfers.length} sent
        <Button size="small" variant="quiet" disabled={transfers.every(isUnderWay)} onClick={onClear}>
          Clear the list
        </Button>
      </div>
      <ul className={styles.list}>
        {transfers.map((transfer) => (
          <li key={transfer.id} className={styles.row}>
            <span className={styles.name} title={transfer.name}>
              {transfer.name}
            </span>
            <span className={styles.size}>{bytes(transfer.nBytes)}</span>
            {transfer.state === "sending" ? (
              <Progress
                label={`${transfer.name}, sent`}
                value={transfer.nSent}
                max={transfer.nBytes}
                className={styles.bar ?? ""}
              />
            ) : (
              <Badge tone={STATES[transfer.state].tone}>{STATES[transfer.state].words}</Badge>
            )}
            {isUnderWay(transfer) && (
              <Button
                size="small"
                aria-label={`Cancel ${transfer.name}`}
                onClick={() => onCancel(transfer.id)}
              >
                Cancel
              </Button>
            )}
            {transfer.error && <p className={styles.error}>{transfer.error}</p>}
          </li>
        ))}
      </ul>
    </section>
  );
}
