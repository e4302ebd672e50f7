import { useEffect, useLayoutEffect, useRef } from "react";
import { Badge, classes } from "../../../components";
import { useObservable } from "../../../drafts/useObservable";
import type { SurfaceMesh } from "../../../geometry/surfaceMesh";
import { paletteOf } from "../../../viewer/colours";
import type { NamedView, UpAxis } from "../../../viewer/pose";
import type { ShapeStage } from "../../../viewer/shapeStage";
import type { ShapeView } from "../../../viewer/shapeView";
import type { HeldShape } from "../desk/heldShape";
import type { Part } from "../parts";
import { type GestureContext, ToolGestures } from "../tools/gestures";
import { LoadingShape } from "./LoadingShape";
import { ShownMenu } from "./ShownMenu";
import { type Shown, whyMissing } from "./shown";
import { useComparison } from "./useComparison";
import styles from "./Viewport.module.css";

export interface LiveView {
  /** Its place among the views, from 0. */
  readonly place: number;
  readonly view: ShapeView;
  readonly gestures: ToolGestures;
}

export interface ViewportProps {
  stage: ShapeStage;
  held: HeldShape;
  place: number;
  shown: Shown;
  onShow: (shown: Shown) => void;
  hasEdges: boolean;
  up: UpAxis;
  /** Such as "View 2 of 4". */
  name: string;
  firstLook: NamedView;
  parts: readonly Part[];
  /** Changes with the colour scheme. */
  scheme: string;
  /** Changes with the settings of the tool in hand. */
  toolKey: string;
  isActive: boolean;
  /** Of the shape, where several are shown. */
  title: string | null;
  context: GestureContext;
  onView: (live: LiveView | null) => void;
  onRetry: () => void;
  onGiveUp: () => void;
}

/** One camera on one shape. */
export function Viewport(props: ViewportProps) {
  const { stage, held, place, shown, up, name, firstLook, parts, scheme, toolKey, isActive, title, context } =
    props;
  const element = useRef<HTMLElement>(null);
  const live = useRef<LiveView | null>(null);
  const state = useObservable(held.state);
  const draft = state.step === "labels" || state.step === "ready" ? state.model : null;
  const facts = useObservable(held.facts);
  const missing = facts && whyMissing(shown, held.lease.model_version !== null, facts.headRevision !== null);
  const comparison = useComparison(held.shapeId, facts && draft, shown, missing);
  const model = comparison.model ?? draft;
  const framed = useRef<{ mesh: SurfaceMesh; look: NamedView } | null>(null);
  const latest = useRef(props);
  latest.current = props;

  useLayoutEffect(() => {
    if (element.current === null) return undefined;
    const view = stage.addView(element.current, { up });
    const gestures = new ToolGestures(view, {
      shelf: context.shelf,
      isDrawnOn: () => latest.current.context.isDrawnOn(),
      open: () => latest.current.context.open(),
      patches: () => latest.current.context.patches(),
      colourOf: (part) => latest.current.context.colourOf(part),
      onEngage: () => latest.current.context.onEngage(),
    });
    view.listen(gestures);
    live.current = { place, view, gestures };
    latest.current.onView(live.current);
    return () => {
      latest.current.onView(null);
      live.current = null;
      view.remove();
    };
  }, [stage, place, up, context.shelf]);

  useEffect(() => {
    if (element.current === null) return undefined;
    const resized = new ResizeObserver(() => live.current?.view.fit());
    resized.observe(element.current);
    return () => resized.disconnect();
  }, []);

  // biome-ignore lint/correctness/useExhaustiveDependencies: the scheme changes what the palette reads
  useLayoutEffect(() => {
    if (model !== null && element.current !== null) model.setPalette(paletteOf(element.current, parts));
  }, [model, parts, scheme]);

  useLayoutEffect(() => {
    const view = live.current?.view;
    if (view === undefined || model === null) return undefined;
    view.show(model, { keepsPose: true });
    const isFramed = framed.current?.mesh === model.mesh && framed.current.look === firstLook;
    if (!isFramed) view.frame(firstLook);
    framed.current = { mesh: model.mesh, look: firstLook };
    return () => view.show(null);
  }, [model, firstLook]);

  useLayoutEffect(() => model?.setWireframe(props.hasEdges), [model, props.hasEdges]);

  // biome-ignore lint/correctness/useExhaustiveDependencies: the key stands for what the gestures read
  useEffect(() => live.current?.gestures.adopt(), [toolKey, model]);

  return (
    <div className={styles.cell}>
      <section
        ref={element}
        className={classes(styles.viewport, isActive && styles.active)}
        // biome-ignore lint/a11y/noNoninteractiveTabindex: keys turn the shape, and press at its middle
        tabIndex={0}
        aria-label={title === null ? name : `${name}: ${title}`}
        onFocus={() => context.onEngage()}
      />
      {title !== null && (
        <span className={styles.title}>
          <Badge tone={isActive ? "accent" : "neutral"} title={title}>
            {title}
          </Badge>
        </span>
      )}
      {draft !== null && <ShownMenu view={name} shown={shown} why={comparison.why} onChoose={props.onShow} />}
      {/* beside the view, which takes every press on it for a gesture */}
      {state.step !== "ready" && (
        <LoadingShape state={state} onGiveUp={props.onGiveUp} onRetry={props.onRetry} />
      )}
    </div>
  );
}
