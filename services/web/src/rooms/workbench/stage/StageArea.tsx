import { type ReactNode, useEffect, useRef, useState } from "react";
import { Button, classes, Notice } from "../../../components";
import { ShapeStage } from "../../../viewer/shapeStage";
import styles from "./StageArea.module.css";
import type { ViewCount } from "./views";

/** The canvas behind all views, and the grid that they stand in. */
export function StageArea(props: {
  count: ViewCount;
  /** There will be no picture, for want of what it takes to draw it. */
  onUnseen: () => void;
  children: (stage: ShapeStage) => ReactNode;
}) {
  const host = useRef<HTMLDivElement>(null);
  const [stage, setStage] = useState<ShapeStage | null>(null);
  const [why, setWhy] = useState<string | null>(null);
  const [isLost, setLost] = useState(false);
  const [attempt, setAttempt] = useState(0);

  // biome-ignore lint/correctness/useExhaustiveDependencies: another canvas, another stage
  useEffect(() => {
    if (host.current === null) return undefined;
    // a canvas of its own: one whose context was given up cannot have another
    const canvas = document.createElement("canvas");
    canvas.className = styles.canvas ?? "";
    host.current.prepend(canvas);
    try {
      const made = new ShapeStage(canvas);
      made.onContext = (state) => setLost(state === "lost");
      setLost(false);
      setStage(made);
      return () => {
        setStage(null);
        made.dispose();
        canvas.remove();
      };
    } catch (error) {
      canvas.remove();
      setWhy(error instanceof Error ? error.message : String(error));
      props.onUnseen();
      return undefined;
    }
  }, [attempt]);

  if (why !== null) {
    return (
      <div className={classes(styles.area, styles.unseen)}>
        <Notice
          kind="error"
          isCentred
          title="Shapes cannot be shown"
          actions={<Button onClick={() => window.location.reload()}>Load the page again</Button>}
        >
          {why}
        </Notice>
      </div>
    );
  }
  return (
    <div ref={host} className={styles.area}>
      <div className={styles.grid} data-count={props.count}>
        {stage !== null && props.children(stage)}
      </div>
      {isLost && (
        <div className={styles.over}>
          <Notice
            kind="warning"
            title="The graphics card was taken away"
            actions={
              <Button size="small" onClick={() => setAttempt(attempt + 1)}>
                Show the shapes again
              </Button>
            }
          >
            Your strokes are safe. It usually comes back by itself.
          </Notice>
        </div>
      )}
    </div>
  );
}
