import { Button } from "../../../components";
import { whole } from "../../../components/numbers";
import { useObservable } from "../../../drafts/useObservable";
import type { Desk } from "../desk/desk";
import type { HeldShape } from "../desk/heldShape";
import type { Part } from "../parts";
import { useCanEdit } from "../shape/useCanEdit";
import type { ToolShelf } from "../tools/toolSettings";
import type { Refinement } from "../tools/useRefinement";
import { EffortLine } from "./EffortLine";
import { HeldShapes } from "./HeldShapes";
import { PartsList } from "./PartsList";
import { RefinePanel } from "./RefinePanel";
import { SaveMark } from "./SaveMark";
import styles from "./ShapePanel.module.css";

export interface ShapePanelProps {
  desk: Desk;
  held: HeldShape;
  parts: readonly Part[];
  shelf: ToolShelf;
  refinement: Refinement;
  isConfirming: boolean;
  /** Whether the shape can be seen: nobody confirms what they cannot see. */
  isSeen: boolean;
  onConfirm: () => void;
  onSkip: () => void;
}

/** All about the shape in hand: what it is, its parts, and how to be done with it. */
export function ShapePanel(props: ShapePanelProps) {
  const { desk, held, parts, shelf, refinement, isConfirming, isSeen, onConfirm, onSkip } = props;
  const { part } = useObservable(shelf.settings);
  const state = useObservable(held.state);
  const facts = useObservable(held.facts);
  const open = state.step === "ready" ? state.open : null;
  const canEdit = useCanEdit(open);
  const { source_key: name, rank, score, score_name, model_version: version } = held.lease;
  return (
    <aside className={styles.panel} aria-label="Shape in hand">
      <header className={styles.header}>
        <div className={styles.nameRow}>
          <h2 className={styles.name} title={name}>
            {name}
          </h2>
          {open !== null && <SaveMark open={open} />}
        </div>
        <dl className={styles.facts}>
          <Fact name="Faces" value={facts?.nFaces == null ? "–" : whole(facts.nFaces)} />
          <Fact name="Rank" value={rank === null ? "–" : whole(rank)} />
          <Fact name={inWords(score_name ?? "score")} value={score === null ? "–" : score.toFixed(3)} />
          <Fact name="Model" value={version === null ? "–" : `v${version}`} />
        </dl>
        <HeldShapes desk={desk} />
      </header>
      <div className={styles.scroll}>
        <PartsList parts={parts} part={part} open={open} onPick={(id) => shelf.change({ part: id })} />
        <RefinePanel
          open={open}
          shelf={shelf}
          refinement={refinement}
          hasConfirmed={facts?.headRevision != null}
        />
      </div>
      <footer className={styles.footer}>
        <EffortLine open={open} />
        <Button onClick={onSkip}>Skip…</Button>
        <Button
          variant="primary"
          className={styles.confirm ?? ""}
          disabled={!(canEdit || isConfirming) || !isSeen}
          isBusy={isConfirming}
          aria-keyshortcuts="Enter"
          title="Confirm these labels and go on to the next shape (Enter)"
          onClick={onConfirm}
        >
          Confirm and next
        </Button>
      </footer>
    </aside>
  );
}

/** `mean_entropy` → "Mean entropy". */
function inWords(scoreName: string): string {
  const words = scoreName.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

function Fact({ name, value }: { name: string; value: string }) {
  return (
    <div className={styles.fact}>
      <dt>{name}</dt>
      <dd title={value}>{value}</dd>
    </div>
  );
}
