import { type ReactNode, useCallback, useState } from "react";
import { Button, Dialog, useToast } from "../../../components";
import { count } from "../../../components/numbers";
import { nameOf, type ShapeRow } from "../rows/shapeRows";
import styles from "./Actions.module.css";
import { grouped, type Outcome, outcomeWords } from "./outcome";

export interface OutcomeTeller {
  /** `done`: such as "sent back, to their authors". `verb`: the same in a word, if it says more. */
  tell(outcome: Outcome, rows: ReadonlyMap<number, ShapeRow>, done: string, verb?: string): void;
  /** The dialog that says what was refused, while there is something to say. */
  readonly dialog: ReactNode;
}

/** Says what was done in the corner, and what was refused in a dialog, shape by shape. */
export function useOutcome(): OutcomeTeller {
  const showToast = useToast();
  const [refused, setRefused] = useState<{ groups: [string, string[]][]; done: string } | null>(null);
  const tell = useCallback<OutcomeTeller["tell"]>(
    (outcome, rows, done, verb = done) => {
      const n = outcome.done.length;
      if (n > 0) showToast({ message: outcomeWords(n, done), tone: "good" });
      if (outcome.refused.length === 0) return;
      const name = (id: number) => nameOf(rows.get(id)?.source_key ?? `shape ${id}`).name;
      setRefused({ groups: grouped(outcome.refused, name), done: verb });
    },
    [showToast],
  );
  const dialog = refused && (
    <Dialog
      title={`${count(
        refused.groups.reduce((sum, [, names]) => sum + names.length, 0),
        "shape",
      )} not ${refused.done}`}
      onClose={() => setRefused(null)}
      footer={
        <Button variant="primary" onClick={() => setRefused(null)}>
          Close
        </Button>
      }
    >
      <ul className={styles.refusals}>
        {refused.groups.map(([why, names]) => (
          <li key={why}>
            <p>{why.charAt(0).toUpperCase() + why.slice(1)}</p>
            <p className={styles.names}>{names.join(", ")}</p>
          </li>
        ))}
      </ul>
    </Dialog>
  );
  return { tell, dialog };
}
