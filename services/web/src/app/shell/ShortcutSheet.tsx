import { Dialog } from "../../components";
import styles from "./ShortcutSheet.module.css";

const ANYWHERE: readonly (readonly [string, string])[] = [
  ["G then T", "Go to the table"],
  ["G then W", "Go to the workbench"],
  ["G then O", "Go to operations"],
  ["G then S", "Go to settings"],
  ["/", "Search names, in the table"],
  ["?", "Keys of the room you are in"],
];

/** Keys that work in every room. Rooms have sheets of their own behind "?". */
export function ShortcutSheet({ onClose }: { onClose: () => void }) {
  return (
    <Dialog title="Keyboard shortcuts" size="small" onClose={onClose}>
      <dl className={styles.keys}>
        {ANYWHERE.map(([keys, meaning]) => (
          <div key={keys} className={styles.row}>
            <dt>{meaning}</dt>
            <dd>
              {keys.split(" ").map((key) => (key === "then" ? ` ${key} ` : <kbd key={key}>{key}</kbd>))}
            </dd>
          </div>
        ))}
      </dl>
    </Dialog>
  );
}
