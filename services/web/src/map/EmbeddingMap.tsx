import { useEffect, useId, useRef, useState } from "react";
import { Button } from "../components";
import { count, whole } from "../components/numbers";
import styles from "./EmbeddingMap.module.css";
import { HoverCard } from "./HoverCard";
import { MapLegend } from "./MapLegend";
import { MapTools } from "./MapTools";
import { MapView } from "./MapView";
import type { MapPanelProps } from "./mapPanelProps";
import type { MapPoints } from "./mapPoints";
import { SpreadOut } from "./SpreadOut";
import { useAim } from "./useAim";
import { useMapGestures } from "./useMapGestures";
import { useMapLook } from "./useMapLook";

/** Every embedded shape as a point: like shapes lie near each other. What is drawn around is selected in the table. */
export function EmbeddingMap(props: MapPanelProps & { readonly points: MapPoints }) {
  const { points, chosen, cluster, collectionId, onChoose, mayOrder } = props;
  const canvas = useRef<HTMLCanvasElement>(null);
  const [{ tool, colouring, camera }, changeLook] = useMapLook(collectionId);
  const [view] = useState(() => new MapView(points, camera));
  const [hovered, setHovered] = useState(-1);
  const [encircled, setEncircled] = useState<readonly number[]>([]);
  const { isAiming, aimed, ...aim } = useAim(view);
  const keysId = useId();
  const shown = hovered >= 0 ? hovered : aimed;

  useEffect(() => {
    if (!canvas.current) return undefined;
    view.connect(canvas.current);
    return () => {
      changeLook({ camera: view.isHome ? null : view.camera });
      view.disconnect();
    };
  }, [view, changeLook]);
  useEffect(() => {
    setHovered(-1); // a place among other points is another shape's
    view.show(points);
  }, [view, points]);
  useEffect(() => view.colourBy(colouring), [view, colouring]);
  useEffect(() => view.mark({ chosen }), [view, chosen]);
  useEffect(() => view.mark({ hovered: shown }), [view, shown]);

  const choose = (places: readonly number[], isAdding: boolean) => {
    const ids = places.map((place) => points.ids[place] as number);
    setEncircled(ids);
    onChoose(ids, isAdding);
  };
  const gestures = useMapGestures(view, canvas, tool, {
    onHover: setHovered,
    onPick: (place, isAdding) => {
      setEncircled([]);
      if (place < 0) {
        if (!isAdding) onChoose([], false);
        return;
      }
      const id = points.ids[place] as number;
      onChoose([id], isAdding);
      props.onShow?.(id);
    },
    onEncircle: choose,
  });
  return (
    <div className={styles.map}>
      <MapTools
        {...{ tool, colouring, view }}
        onTool={(wanted) => changeLook({ tool: wanted })}
        onColouring={(wanted) => changeLook({ colouring: wanted })}
      />
      <div className={styles.canvasFrame} data-tool={tool}>
        {/* biome-ignore lint/a11y/noInteractiveElementToNoninteractiveRole: it takes keys of its own */}
        <canvas
          ref={canvas}
          className={styles.canvas}
          tabIndex={0}
          role="application"
          aria-label={`Map of ${count(points.n, "shape")}`}
          aria-describedby={keysId}
          {...gestures}
          {...aim}
        />
        <p id={keysId} className="unseen">
          Arrow keys move, plus and minus zoom, 0 shows all. Enter selects the shape in the middle, with Shift
          beside those that are selected.
        </p>
        {isAiming && <span className={styles.crosshair} aria-hidden="true" />}
        {shown >= 0 && <HoverCard points={points} place={shown} isAimed={shown === aimed} />}
      </div>
      <div className={styles.choosing}>
        <Button size="small" onClick={() => choose(view.inView(), false)}>
          Select what is in view
        </Button>
        {cluster !== null && (
          <Button size="small" onClick={() => choose(placesOf(points, cluster), false)}>
            Select cluster {whole(cluster + 1)}
          </Button>
        )}
      </div>
      {mayOrder && encircled.length > 1 && <SpreadOut collectionId={collectionId} shapeIds={encircled} />}
      <MapLegend points={points} colouring={colouring} cluster={cluster} onCluster={props.onCluster} />
    </div>
  );
}

function placesOf(points: MapPoints, cluster: number): number[] {
  const places: number[] = [];
  points.cluster.forEach((each, place) => {
    if (each === cluster) places.push(place);
  });
  return places;
}
