import { X } from "lucide-react";
import { type ReactNode, useCallback, useMemo } from "react";
import { useHasRole } from "../../app/session/MeContext";
import { IconButton } from "../../components";
import { MapPanel } from "../../map/MapPanel";
import { PartsPanel } from "../../parts/PartsPanel";
import { ReviewsPanel } from "../../reviews/ReviewsPanel";
import { fetchNamedRows, type RowList } from "./rows/tableQueries";
import styles from "./SidePanel.module.css";
import { MAX_CHOSEN } from "./selection/selection";
import type { SelectionState } from "./selection/useSelection";
import type { Panel } from "./view/tableView";
import type { TableViewState } from "./view/useTableView";

const TITLES: Readonly<Record<Panel, string>> = { map: "Map", parts: "Parts", reviews: "Reviews" };

export interface SidePanelProps {
  readonly collectionId: number;
  readonly list: RowList;
  readonly state: TableViewState;
  readonly selection: SelectionState;
}

/** The panel beside the grid that the address names. */
export function SidePanel({ collectionId, list, state, selection }: SidePanelProps) {
  const { panel, filters } = state.view;
  const isReviewer = useHasRole("reviewer");
  const choose = useChoice(list, selection);
  const { chosen } = selection.selection;
  const ids = useMemo(() => new Set(chosen.keys()), [chosen]);
  if (panel === null || (panel === "reviews" && !isReviewer)) return null;
  const contents: Readonly<Record<Panel, () => ReactNode>> = {
    map: () => (
      <MapPanel
        collectionId={collectionId}
        chosen={ids}
        cluster={filters.cluster}
        mayOrder={isReviewer}
        onChoose={choose}
        onCluster={(cluster) => state.filter({ cluster })}
      />
    ),
    parts: () => <PartsPanel collectionId={collectionId} mayChange={isReviewer} />,
    reviews: () => <ReviewsPanel collectionId={collectionId} />,
  };
  return (
    <aside className={styles.panel} aria-label={TITLES[panel]}>
      <header className={styles.header}>
        <h2>{TITLES[panel]}</h2>
        <IconButton size="small" label="Close" icon={<X />} onClick={() => state.change({ panel: null })} />
      </header>
      <div className={styles.body}>{contents[panel]()}</div>
    </aside>
  );
}

/** Selects shapes that were picked elsewhere, whose rows may not be on screen. */
function useChoice(list: RowList, { take, none }: SelectionState) {
  return useCallback(
    (shapeIds: readonly number[], isAdding: boolean) => {
      if (shapeIds.length > 0) {
        const nMore = Math.max(0, shapeIds.length - MAX_CHOSEN);
        take(fetchNamedRows(list, shapeIds.slice(0, MAX_CHOSEN)), isAdding, nMore);
      } else if (!isAdding) none();
    },
    [list, take, none],
  );
}
