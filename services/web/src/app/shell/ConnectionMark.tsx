import { classes } from "../../components";
import { type ConnectionState, useConnection } from "../events/useServiceEvents";
import styles from "./ConnectionMark.module.css";

const WORDS: Readonly<Record<ConnectionState, { name: string; meaning: string }>> = {
  connecting: { name: "Connecting", meaning: "Changes by others will show by themselves in a moment." },
  connected: { name: "Connected", meaning: "Changes by others show by themselves." },
  reconnecting: {
    name: "Reconnecting",
    meaning: "The service does not answer. Strokes are kept in this browser and sent once it is back.",
  },
  offline: {
    name: "Offline",
    meaning: "This computer has no network. Strokes are kept in this browser and sent once it is back.",
  },
};

/** Whether the page and the service hear each other. In words as soon as something is wrong. */
export function ConnectionMark() {
  const connection = useConnection();
  const { name, meaning } = WORDS[connection];
  const isWrong = connection === "reconnecting" || connection === "offline";
  return (
    <div role="status" aria-label="Connection" title={`${name}. ${meaning}`} className={styles.mark}>
      <span className={classes(styles.dot, styles[connection])} aria-hidden="true" />
      <span className={isWrong ? styles.words : "unseen"}>{name}</span>
    </div>
  );
}
