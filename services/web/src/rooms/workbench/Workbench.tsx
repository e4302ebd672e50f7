import { useRef, useState } from "react";
import { useCollection } from "../../app/CollectionContext";
import { RoomHeading } from "../../app/RoomHeading";
import { useScheme } from "../../app/scheme/useScheme";
import { useToast } from "../../components";
import { useObservable } from "../../drafts/useObservable";
import type { NamedView, UpAxis } from "../../viewer/pose";
import type { Desk } from "./desk/desk";
import type { HeldShape } from "./desk/heldShape";
import { useConfirming } from "./desk/useConfirming";
import { SkipDialog } from "./dialogs/SkipDialog";
import { ShortcutSheet } from "./keys/ShortcutSheet";
import { useShortcuts } from "./keys/useShortcuts";
import { ShapePanel } from "./panel/ShapePanel";
import type { Part } from "./parts";
import { StageNotices } from "./StageNotices";
import { Stage } from "./stage/Stage";
import { nextShown, type Shown } from "./stage/shown";
import { ViewControls } from "./stage/ViewControls";
import type { LiveView } from "./stage/Viewport";
import { nextCount, ONE_VIEW, shownAt, type Views, withShown } from "./stage/views";
import { ToolOptions } from "./tools/ToolOptions";
import { ToolRail } from "./tools/ToolRail";
import type { ToolShelf } from "./tools/toolSettings";
import { useKnownParts } from "./tools/useKnownParts";
import { usePatches } from "./tools/usePatches";
import { useRefinement } from "./tools/useRefinement";
import styles from "./Workbench.module.css";

export interface WorkbenchProps {
  desk: Desk;
  held: HeldShape;
  parts: readonly Part[];
  shelf: ToolShelf;
}

type Opened = "skip" | "keys" | null;

/** A shape in hand, with everything that can be done to it. */
export function Workbench({ desk, held, parts, shelf }: WorkbenchProps) {
  const collection = useCollection();
  const showToast = useToast();
  const [scheme] = useScheme();
  const settings = useObservable(shelf.settings);
  const state = useObservable(held.state);
  const open = state.step === "ready" ? state.open : null;
  const active = useRef<LiveView | null>(null);
  const [views, setViews] = useState(ONE_VIEW);
  const [isSeen, setSeen] = useState(true);
  const [dialog, setDialog] = useState<Opened>(null);
  const patches = usePatches(open, settings.tool === "patches", settings.nPatches, settings.method);
  const refinement = useRefinement(open);
  const confirming = useConfirming(desk, held);
  useKnownParts(shelf, open, parts);
  const up = upAxisOf(collection.settings.up);
  const changeViews = (some: Partial<Views>) => setViews((known) => ({ ...known, ...some }));
  const changeShown = (next: (shown: Shown) => Shown) => {
    const place = active.current?.place ?? 0;
    changeViews({ shown: withShown(views, place, next(shownAt(views, place))) });
  };
  const look = (name?: NamedView) => active.current?.view.frame(name);

  useShortcuts({
    useTool: (tool) => shelf.change({ tool }),
    usePart(place) {
      const part = parts[place];
      if (part !== undefined) shelf.change({ part: part.id });
    },
    unlabel: () => shelf.change({ part: 0 }),
    scaleBrush: (direction) => shelf.scaleBrush(direction),
    morePatches: (direction) => shelf.morePatches(direction),
    toggleAngleLimit: () => shelf.change({ hasAngleLimit: !settings.hasAngleLimit }),
    press() {
      const why = active.current?.gestures.pressAtCentre() ?? null;
      if (why !== null) showToast({ message: why });
    },
    undo: () => open?.undo(),
    redo: () => open?.redo(),
    refineBoundaries: () => refinement.boundaries(settings.omega),
    refineWithModel: () => refinement.model(),
    confirm: () => isSeen && void confirming.confirm(),
    skip: () => setDialog("skip"),
    nextShape() {
      const { shapes } = desk.state.get();
      const next = shapes[(shapes.indexOf(held) + 1) % shapes.length];
      if (next !== undefined) desk.show(next);
    },
    cycleViews: () => changeViews({ count: nextCount(views.count) }),
    toggleLink: () => changeViews({ isLinked: !views.isLinked }),
    cycleShown: () => changeShown(nextShown),
    toggleUncertainty: () => changeShown((shown) => (shown === "uncertainty" ? "draft" : "uncertainty")),
    toggleEdges: () => changeViews({ hasEdges: !views.hasEdges }),
    frame: () => look(),
    look,
    showKeys: () => setDialog("keys"),
  });

  return (
    <div className={styles.bench}>
      <RoomHeading title={held.lease.source_key} isUnseen />
      <ToolRail shelf={shelf} open={open} onRefine={() => refinement.boundaries(settings.omega)} />
      <div className={styles.bar}>
        <ToolOptions shelf={shelf} parts={parts} patches={patches} />
        <ViewControls views={views} onChange={changeViews} onFrame={look} />
      </div>
      <div className={styles.notices} aria-live="polite">
        <StageNotices desk={desk} held={held} open={open} confirming={confirming} />
      </div>
      <div className={styles.stage}>
        <Stage
          {...{ desk, shelf, parts, patches, views, up, scheme }}
          onActive={(live) => {
            active.current = live;
          }}
          onUnseen={() => setSeen(false)}
          onViews={changeViews}
          onRetry={(shape) =>
            void shape.retry({ partIds: parts.map((part) => part.id), start: settings.start })
          }
        />
      </div>
      <div className={styles.side}>
        <ShapePanel
          {...{ desk, held, parts, shelf, refinement }}
          isConfirming={confirming.isBusy}
          isSeen={isSeen}
          onConfirm={() => void confirming.confirm()}
          onSkip={() => setDialog("skip")}
        />
      </div>
      {dialog === "keys" && <ShortcutSheet onClose={() => setDialog(null)} />}
      {dialog === "skip" && (
        <SkipDialog
          name={held.lease.source_key}
          onClose={() => setDialog(null)}
          onSkip={async (reason) => {
            await desk.skip(held, reason);
            setDialog(null);
          }}
        />
      )}
    </div>
  );
}

function upAxisOf(up: unknown): UpAxis {
  return up === "x" || up === "z" ? up : "y";
}
