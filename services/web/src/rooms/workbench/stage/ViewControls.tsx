import {
  Boxes,
  ChevronDown,
  Columns2,
  Eye,
  Grid2x2,
  Grid3x3,
  Link2,
  Maximize,
  PanelsLeftBottom,
  Square,
} from "lucide-react";
import type { ReactNode } from "react";
import { IconButton, Menu, MenuItem, Segmented } from "../../../components";
import type { NamedView } from "../../../viewer/pose";
import { keysFor } from "../keys/shortcuts";
import styles from "./ViewControls.module.css";
import type { ViewCount, Views } from "./views";

const COUNTS: readonly { value: `${ViewCount}`; label: string; icon: ReactNode }[] = [
  { value: "1", label: "One view", icon: <Square /> },
  { value: "2", label: "Two views", icon: <Columns2 /> },
  { value: "3", label: "Three views", icon: <PanelsLeftBottom /> },
  { value: "4", label: "Four views", icon: <Grid2x2 /> },
];
const LOOKS: readonly [NamedView, string][] = [
  ["threeQuarter", "From a corner"],
  ["front", "From the front"],
  ["back", "From the back"],
  ["left", "From the left"],
  ["right", "From the right"],
  ["top", "From the top"],
  ["bottom", "From below"],
];

export interface ViewControlsProps {
  views: Views;
  onChange: (some: Partial<Views>) => void;
  onFrame: (look?: NamedView) => void;
}

/** How many views there are, what they show, and where the active one looks from. */
export function ViewControls({ views, onChange, onFrame }: ViewControlsProps) {
  return (
    <div className={styles.controls}>
      {views.count > 1 && (
        <>
          <IconButton
            label="A shape in each view"
            size="small"
            icon={<Boxes />}
            isPressed={views.content === "shapes"}
            onClick={() => onChange({ content: views.content === "shapes" ? "cameras" : "shapes" })}
          />
          <IconButton
            label="Link cameras"
            shortcut={keysFor("Link the cameras")}
            size="small"
            icon={<Link2 />}
            isPressed={views.isLinked}
            onClick={() => onChange({ isLinked: !views.isLinked })}
          />
        </>
      )}
      <IconButton
        label="Edges of faces"
        shortcut={keysFor("Edges of faces")}
        size="small"
        icon={<Grid3x3 />}
        isPressed={views.hasEdges}
        onClick={() => onChange({ hasEdges: !views.hasEdges })}
      />
      <Segmented
        label="Number of views"
        size="small"
        value={`${views.count}`}
        options={COUNTS}
        onChange={(value) => onChange({ count: Number(value) as ViewCount })}
      />
      <Menu
        label="Look from"
        alignment="end"
        className={styles.look}
        trigger={
          <>
            <Eye aria-hidden="true" />
            <ChevronDown aria-hidden="true" />
          </>
        }
      >
        {LOOKS.map(([look, words]) => (
          <MenuItem key={look} onSelect={() => onFrame(look)} shortcut={keysFor(words)}>
            {words}
          </MenuItem>
        ))}
      </Menu>
      <IconButton
        label="Whole shape in view"
        shortcut={keysFor("Whole shape in view")}
        size="small"
        icon={<Maximize />}
        onClick={() => onFrame()}
      />
    </div>
  );
}
