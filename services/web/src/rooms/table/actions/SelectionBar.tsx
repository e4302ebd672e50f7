import { ClipboardCheck, ListRestart, PenTool, Undo2, UserRoundPlus, X } from "lucide-react";
import { type ReactNode, useState } from "react";
import { useHasRole } from "../../../app/session/MeContext";
import { Button, IconButton } from "../../../components";
import { whole } from "../../../components/numbers";
import type { ShapeRow } from "../rows/shapeRows";
import { MAX_CHOSEN } from "../selection/selection";
import type { SelectionState } from "../selection/useSelection";
import { AcceptDialog } from "./AcceptDialog";
import styles from "./Actions.module.css";
import { AssignDialog } from "./AssignDialog";
import { MAX_OPEN } from "./limits";
import { PutBackDialog } from "./PutBackDialog";
import { PutFirstButton } from "./PutFirstButton";
import { SendBackDialog } from "./SendBackDialog";
import { useOutcome } from "./useOutcome";

const DIALOGS = {
  accept: AcceptDialog,
  assign: AssignDialog,
  sendBack: SendBackDialog,
  putBack: PutBackDialog,
};
type Action = keyof typeof DIALOGS;

export interface SelectionBarProps {
  readonly collectionId: number;
  readonly selection: SelectionState;
  onActed(shapeIds: readonly number[]): void;
  onOpen(rows: readonly ShapeRow[]): void;
}

/** How many shapes are selected, and what can be done with them. */
export function SelectionBar({ collectionId, selection, onActed, onOpen }: SelectionBarProps) {
  const [asked, setAsked] = useState<{ action: Action; rows: ReadonlyMap<number, ShapeRow> } | null>(null);
  const isReviewer = useHasRole("reviewer");
  const isOperator = useHasRole("operator");
  const teller = useOutcome();
  const { chosen, nBeyond } = selection.selection;
  const button = (action: Action, icon: ReactNode, words: string) => (
    <Button size="small" variant="quiet" icon={icon} onClick={() => setAsked({ action, rows: chosen })}>
      {words}
    </Button>
  );
  const Asked = asked && DIALOGS[asked.action];
  return (
    <>
      {chosen.size > 0 && (
        <div className={styles.bar} role="toolbar" aria-label="Selected shapes">
          <div className={styles.actions}>
            <p className={styles.selected} role="status">
              {whole(chosen.size)} selected
              {nBeyond > 0 && (
                <span className={styles.beyond}>
                  , the first of {whole(chosen.size + nBeyond)}; up to {whole(MAX_CHOSEN)} at a time
                </span>
              )}
            </p>
            <Button
              size="small"
              variant="primary"
              icon={<PenTool />}
              onClick={() => onOpen([...chosen.values()])}
            >
              {chosen.size > MAX_OPEN ? `Open the first ${MAX_OPEN}` : "Open"}
            </Button>
            {isReviewer && button("accept", <ClipboardCheck />, "Accept…")}
            {isReviewer && button("sendBack", <Undo2 />, "Send back…")}
            {isReviewer && <PutFirstButton collectionId={collectionId} shapeIds={[...chosen.keys()]} />}
            {isOperator && button("assign", <UserRoundPlus />, "Assign…")}
            {isOperator && button("putBack", <ListRestart />, "Put back…")}
          </div>
          <IconButton
            size="small"
            label="Select none"
            shortcut="Escape"
            icon={<X />}
            onClick={selection.none}
          />
        </div>
      )}
      {Asked && (
        <Asked {...{ collectionId, teller, onActed }} rows={asked.rows} onClose={() => setAsked(null)} />
      )}
      {teller.dialog}
    </>
  );
}
