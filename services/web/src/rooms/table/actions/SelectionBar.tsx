import type { ShapeRow } from "../rows/shapeRows";
import type { SelectionState } from "../selection/useSelection";

export interface SelectionBarProps {
  readonly collectionId: number;
  readonly selection: SelectionState;
  onOpen(rows: readonly ShapeRow[]): void;
}

export function SelectionBar(_props: SelectionBarProps) {
  return null;
}
