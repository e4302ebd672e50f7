import { useEffect, useMemo, useRef, useState } from "react";
import { whole } from "../components/numbers";
import type { Colouring } from "./colours";
import styles from "./EmbeddingMap.module.css";
import { HoverCard } from "./HoverCard";
import { MapLegend } from "./MapLegend";
import { MapTools } from "./MapTools";
import { MapView } from "./MapView";
import type { MapPanelProps } from "./mapPanelProps";
import type { MapPoints } from "./mapPoints";
import { SpreadOut } from "./SpreadOut";
import { type Tool, useMapGestures } from "./useMapGestures";

/** Every embedded shape as a point: like shapes lie near each other. What is drawn around is selected in the table. */
export function EmbeddingMap(props: MapPanelProps & { readonly points: MapPoints }) {
  const { points, chosen, collectionId, onChoose, mayOrder } = props;
  const canvas = useRef<HTMLCanvasElement>(null);
  const view = useMemo(() => new MapView(points), [points]);
  const [tool, setTool] = useState<Tool>("move");
  const [colouring, setColouring] = useState<Colouring>("cluster");
  const [hovered, setHovered] = useState(-1);
  const [encircled, setEncircled] = useState<readonly number[]>([]);
  const idsOf = (places: readonly number[]) => places.map((place) => points.ids[place] as number);

  useEffect(() => {
    if (!canvas.current) return undefined;
    view.connect(canvas.current);
    return () => view.disconnect();
  }, [view]);
  useEffect(() => view.colourBy(colouring), [view, colouring]);
  useEffect(() => view.mark({ chosen }), [view, chosen]);
  useEffect(() => view.mark({ hovered }), [view, hovered]);

  const gestures = useMapGestures(view, canvas, tool, {
    onHover: setHovered,
    onPick: (place, isAdding) => {
      setEncircled([]);
      if (place >= 0) onChoose(idsOf([place]), isAdding);
      else if (!isAdding) onChoose([], false);
    },
    onEncircle: (places, isAdding) => {
      const ids = idsOf(places);
      setEncircled(ids);
      onChoose(ids, isAdding);
    },
  });
  const words = `Map of ${whole(points.n)} shapes. Arrow keys move, plus and minus zoom, 0 shows all.`;
  return (
    <div className={styles.map}>
      <MapTools {...{ tool, colouring, view }} onTool={setTool} onColouring={setColouring} />
      <div className={styles.canvasFrame} data-tool={tool}>
        <canvas
          ref={canvas}
          className={styles.canvas}
          role="img"
          tabIndex={0}
          aria-label={words}
          {...gestures}
        />
        {hovered >= 0 && <HoverCard points={points} place={hovered} />}
      </div>
      {mayOrder && encircled.length > 1 && <SpreadOut collectionId={collectionId} shapeIds={encircled} />}
      <MapLegend points={points} colouring={colouring} cluster={props.cluster} onCluster={props.onCluster} />
    </div>
  );
}
