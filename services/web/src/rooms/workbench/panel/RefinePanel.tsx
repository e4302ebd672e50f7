import { ChevronDown } from "lucide-react";
import { Button, Menu, MenuChoice, MenuHeading, MenuItem, MenuLine, Slider } from "../../../components";
import { useObservable, useObservableOr } from "../../../drafts/useObservable";
import type { OpenShape } from "../shape/openShape";
import { useCanEdit } from "../shape/useCanEdit";
import type { StartChoice, ToolShelf } from "../tools/toolSettings";
import type { Refinement } from "../tools/useRefinement";
import styles from "./RefinePanel.module.css";

const STARTS: readonly (readonly [StartChoice, string])[] = [
  ["best", "The best there is"],
  ["refined", "Refined labels"],
  ["predicted", "Predicted labels"],
  ["nothing", "Nothing"],
];

export interface RefinePanelProps {
  open: OpenShape | null;
  shelf: ToolShelf;
  refinement: Refinement;
  hasConfirmed: boolean;
}

/** Refinements and what to start from: each one step, to be taken back like any other. */
export function RefinePanel({ open, shelf, refinement, hasConfirmed }: RefinePanelProps) {
  const { omega } = useObservable(shelf.settings);
  useObservableOr(open?.version, 0);
  const canEdit = useCanEdit(open);
  const isAgain = open !== null && open.anchor !== null;
  return (
    <section className={styles.refine} aria-label="Refine and start">
      <h3 className={styles.heading}>Refine</h3>
      <Slider
        label="Weight of angles (ω)"
        value={omega}
        min={0}
        max={1}
        step={0.05}
        format={(value) => value.toFixed(2)}
        onChange={(value) => shelf.change({ omega: value })}
      />
      <div className={styles.buttons}>
        <Button
          size="small"
          disabled={!canEdit}
          isBusy={refinement.running === "boundaries"}
          title="Moves boundaries onto creases and fills what is unlabelled (R)"
          onClick={() => refinement.boundaries(omega)}
        >
          {isAgain ? "Boundaries again" : "Boundaries"}
        </Button>
        <Button
          size="small"
          disabled={!canEdit}
          isBusy={refinement.running === "model"}
          title="The newest model's word on the shape, cut along creases (M)"
          onClick={() => refinement.model()}
        >
          With the model
        </Button>
      </div>
      <StartMenu open={open} shelf={shelf} refinement={refinement} hasConfirmed={hasConfirmed} />
    </section>
  );
}

function StartMenu({ open, shelf, refinement, hasConfirmed }: RefinePanelProps) {
  const canEdit = useCanEdit(open);
  const { start } = useObservable(shelf.settings);
  const hasOpened = open?.opened.some((label) => label !== 0) ?? false;
  const cutAnew = () => {
    open?.perform({ kind: "clear" });
    shelf.change({ tool: "patches" });
  };
  return (
    <Menu
      label="Start from"
      variant="framed"
      trigger={
        <>
          Start from <ChevronDown aria-hidden="true" />
        </>
      }
      isDisabled={!canEdit}
    >
      <MenuItem onSelect={() => open?.perform({ kind: "clear" })}>Nothing</MenuItem>
      <MenuItem onSelect={cutAnew}>Patches</MenuItem>
      <MenuItem onSelect={() => refinement.startFrom("predicted")}>Predicted labels</MenuItem>
      <MenuItem onSelect={() => refinement.startFrom("refined")}>Refined labels</MenuItem>
      <MenuItem isDisabled={!hasConfirmed} onSelect={() => refinement.startFrom("confirmed")}>
        Confirmed labels
      </MenuItem>
      <MenuItem isDisabled={!hasOpened} onSelect={() => refinement.startAsOpened()}>
        Last draft, as it was opened
      </MenuItem>
      <MenuLine />
      <MenuHeading>New shapes start from</MenuHeading>
      {STARTS.map(([choice, words]) => (
        <MenuChoice
          key={choice}
          isChecked={start === choice}
          onSelect={() => shelf.change({ start: choice })}
        >
          {words}
        </MenuChoice>
      ))}
    </Menu>
  );
}
