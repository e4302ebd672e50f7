import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "react";
import { Button, Notice } from "../../../components";
import { useObservable } from "../../../drafts/useObservable";
import { resolvedColour } from "../../../viewer/colours";
import type { UpAxis } from "../../../viewer/pose";
import type { ShapeStage } from "../../../viewer/shapeStage";
import type { Desk } from "../desk/desk";
import type { HeldShape } from "../desk/heldShape";
import type { Part } from "../parts";
import type { GestureContext } from "../tools/gestures";
import type { ToolShelf } from "../tools/toolSettings";
import type { Patches } from "../tools/usePatches";
import styles from "./Stage.module.css";
import { StageArea } from "./StageArea";
import { type LiveView, Viewport } from "./Viewport";
import { FIRST_LOOKS, inViews, shownAt, type Views, withShown } from "./views";

export interface StageProps {
  desk: Desk;
  shelf: ToolShelf;
  parts: readonly Part[];
  patches: Patches;
  views: Views;
  up: UpAxis;
  scheme: string;
  /** Another view is the one that keys act on, which is marked. */
  onActive: (live: LiveView | null) => void;
  onUnseen: () => void;
  onViews: (some: Partial<Views>) => void;
  onRetry: (held: HeldShape) => void;
}

/** All views, on one canvas. */
export function Stage(props: StageProps) {
  const { desk, views } = props;
  const { shapes, current } = useObservable(desk.state);
  const isByShape = views.content === "shapes" && views.count > 1;
  const shown = isByShape
    ? inViews(shapes, current, views.count)
    : Array.from({ length: views.count }, () => current);
  return (
    <StageArea count={views.count} onUnseen={props.onUnseen}>
      {(stage) => <ViewGrid {...props} stage={stage} shown={shown} isByShape={isByShape} current={current} />}
    </StageArea>
  );
}

interface ViewGridProps extends StageProps {
  stage: ShapeStage;
  shown: readonly (HeldShape | null)[];
  isByShape: boolean;
  current: HeldShape | null;
}

function ViewGrid(props: ViewGridProps) {
  const { stage, shown, isByShape, current, views, desk, onActive } = props;
  const live = useRef<(LiveView | null)[]>([]);
  const [engaged, setEngaged] = useState(0);
  const active = isByShape ? shown.indexOf(current) : Math.min(engaged, views.count - 1);

  useLayoutEffect(() => {
    onActive(live.current[active] ?? null); // each time: the view at the place may be another one
    return () => onActive(null);
  });

  useLayoutEffect(() => {
    const hasFocus = live.current.some((each) => each?.view.element === document.activeElement);
    if (hasFocus) live.current[active]?.view.element.focus({ preventScroll: true });
  }, [active]);

  useEffect(() => {
    for (const held of shown) if (held !== null) desk.begin(held);
  });

  const shownIds = shown.map((held) => held?.shapeId).join();
  // biome-ignore lint/correctness/useExhaustiveDependencies: other views are to be linked once others are shown
  useEffect(() => {
    const linked = live.current.flatMap((each) => each?.view ?? []);
    stage.link(views.isLinked ? linked : []);
  }, [stage, views.isLinked, views.count, shownIds]);

  return shown.map((held, at) => {
    const engage = () => {
      setEngaged(at);
      if (held !== null && held !== current) desk.show(held);
    };
    const key = `${at}`;
    if (held === null) return <EmptyView key={key} desk={desk} />;
    return (
      <OneView
        key={key}
        {...props}
        held={held}
        at={at}
        isActive={at === active}
        onEngage={engage}
        onLive={(view) => {
          live.current[at] = view;
        }}
      />
    );
  });
}

interface OneViewProps extends ViewGridProps {
  held: HeldShape;
  at: number;
  isActive: boolean;
  onEngage: () => void;
  onLive: (live: LiveView | null) => void;
}

function OneView(props: OneViewProps) {
  const { stage, shelf, parts, patches, views, held, at, isByShape, onEngage, onLive, scheme } = props;
  const settings = useObservable(shelf.settings);
  const { tool, part, radius, hasAngleLimit, angleDegrees, onlyOver } = settings;
  const shown = shownAt(views, at);
  const toolKey = [tool, part, radius, hasAngleLimit && angleDegrees, onlyOver, shown].join(" ");
  const isCurrent = held === props.current;
  const colours = useMemo(() => new Map(parts.map((part) => [part.id, part.colour])), [parts]);
  const context: GestureContext = {
    shelf,
    isDrawnOn: () => shown === "draft",
    open: () => (shown === "draft" ? held.open : null),
    patches: () => (isCurrent ? patches.map : null),
    colourOf: (part) => colours.get(part) ?? resolvedColour(document.body, "var(--unlabelled)"),
    onEngage,
  };
  return (
    <Viewport
      stage={stage}
      held={held}
      place={at}
      shown={shown}
      onShow={(next) => props.onViews({ shown: withShown(views, at, next) })}
      hasEdges={views.hasEdges}
      up={props.up}
      name={views.count === 1 ? "Shape" : `View ${at + 1} of ${views.count}`}
      firstLook={isByShape ? FIRST_LOOKS[0] : (FIRST_LOOKS[at] ?? FIRST_LOOKS[0])}
      parts={parts}
      scheme={scheme}
      toolKey={toolKey}
      isActive={props.isActive}
      title={isByShape ? held.lease.source_key : null}
      context={context}
      onView={onLive}
      onRetry={() => props.onRetry(held)}
      onGiveUp={() => void props.desk.release(held)}
    />
  );
}

function EmptyView({ desk }: { desk: Desk }) {
  return (
    <div className={styles.empty}>
      <Notice
        kind="empty"
        title="Room for another shape"
        actions={<Button onClick={() => void desk.takeNext()}>Take the next of the queue</Button>}
      >
        Or choose shapes in the table and open them here.
      </Notice>
    </div>
  );
}
