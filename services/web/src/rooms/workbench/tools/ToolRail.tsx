import { Brush, Hand, PaintBucket, Pipette, Puzzle, Redo2, Spline, Undo2 } from "lucide-react";
import type { ReactNode } from "react";
import { IconButton } from "../../../components";
import { useObservable, useObservableOr } from "../../../drafts/useObservable";
import { keysFor } from "../keys/shortcuts";
import type { OpenShape } from "../shape/openShape";
import { useCanEdit } from "../shape/useCanEdit";
import styles from "./ToolRail.module.css";
import type { ToolName, ToolShelf } from "./toolSettings";

const TOOLS: readonly {
  readonly name: ToolName;
  readonly label: string;
  readonly icon: ReactNode;
  readonly keys: string;
}[] = [
  { name: "paint", label: "Paint", icon: <Brush />, keys: "Paint" },
  { name: "patches", label: "Patches", icon: <Puzzle />, keys: "Patches" },
  { name: "segment", label: "Whole segment", icon: <PaintBucket />, keys: "Whole segment" },
  { name: "pick", label: "Pick a part", icon: <Pipette />, keys: "Pick the part under the pointer" },
  { name: "turn", label: "Turn", icon: <Hand />, keys: "Turn the shape" },
];

/** Tools on the left; undo and redo below them. */
export function ToolRail({
  shelf,
  open,
  onRefine,
}: {
  shelf: ToolShelf;
  open: OpenShape | null;
  onRefine: () => void;
}) {
  const { tool } = useObservable(shelf.settings);
  useObservableOr(open?.version, 0);
  const canEdit = useCanEdit(open);
  return (
    <div className={styles.rail} role="toolbar" aria-label="Tools" aria-orientation="vertical">
      {TOOLS.map(({ name, label, icon, keys }) => (
        <IconButton
          key={name}
          label={label}
          icon={icon}
          shortcut={keysFor(keys)}
          isPressed={tool === name}
          onClick={() => shelf.change({ tool: name })}
        />
      ))}
      <hr className={styles.line} />
      <IconButton
        label="Refine boundaries"
        icon={<Spline />}
        shortcut={keysFor("Refine boundaries")}
        disabled={!canEdit}
        onClick={onRefine}
      />
      <span className={styles.space} />
      <IconButton
        label="Undo"
        icon={<Undo2 />}
        shortcut={keysFor("Undo")}
        disabled={!canEdit || !open?.editor.canUndo}
        onClick={() => open?.undo()}
      />
      <IconButton
        label="Redo"
        icon={<Redo2 />}
        shortcut={keysFor("Redo")}
        disabled={!canEdit || !open?.editor.canRedo}
        onClick={() => open?.redo()}
      />
    </div>
  );
}
