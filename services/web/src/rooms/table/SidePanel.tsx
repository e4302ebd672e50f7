import type { SelectionState } from "./selection/useSelection";
import type { TableViewState } from "./view/useTableView";

export interface SidePanelProps {
  readonly collectionId: number;
  readonly state: TableViewState;
  readonly selection: SelectionState;
}

/** What is beside the grid. */
export function SidePanel(_props: SidePanelProps) {
  return null;
}
