import { Hand, LassoSelect, Maximize, SquareDashedMousePointer, ZoomIn, ZoomOut } from "lucide-react";
import { IconButton, Segmented } from "../components";
import { zoomedAt } from "./camera";
import type { Colouring } from "./colours";
import styles from "./EmbeddingMap.module.css";
import type { MapView } from "./MapView";
import type { Tool } from "./useMapGestures";

const STEP = 1.5;

export interface MapToolsProps {
  readonly tool: Tool;
  readonly colouring: Colouring;
  readonly view: MapView;
  onTool(tool: Tool): void;
  onColouring(colouring: Colouring): void;
}

/** What the pointer does on the map, how near it is, and what colours mean. */
export function MapTools({ tool, colouring, view, onTool, onColouring }: MapToolsProps) {
  const zoom = (factor: number) => {
    const middle = [view.size.width / 2, view.size.height / 2] as const;
    view.look(zoomedAt(view.camera, view.size, middle, factor, view.homeCamera));
  };
  return (
    <div className={styles.tools} role="toolbar" aria-label="Map">
      <Segmented
        label="Tool"
        size="small"
        value={tool}
        options={[
          { value: "move", label: "Move", icon: <Hand /> },
          { value: "lasso", label: "Lasso", icon: <LassoSelect /> },
          { value: "rectangle", label: "Rectangle", icon: <SquareDashedMousePointer /> },
        ]}
        onChange={onTool}
      />
      <span className={styles.zoom}>
        <IconButton
          size="small"
          label="Zoom out"
          shortcut="-"
          icon={<ZoomOut />}
          onClick={() => zoom(1 / STEP)}
        />
        <IconButton size="small" label="Zoom in" shortcut="+" icon={<ZoomIn />} onClick={() => zoom(STEP)} />
        <IconButton
          size="small"
          label="Show all"
          shortcut="0"
          icon={<Maximize />}
          onClick={() => view.goHome()}
        />
      </span>
      <Segmented
        label="Colour by"
        size="small"
        value={colouring}
        options={[
          { value: "cluster", label: "Clusters" },
          { value: "state", label: "States" },
        ]}
        onChange={onColouring}
      />
    </div>
  );
}
