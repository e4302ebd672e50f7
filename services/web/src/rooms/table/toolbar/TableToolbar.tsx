import { useQuery } from "@tanstack/react-query";
import { ArrowDownNarrowWide, ArrowUpNarrowWide, ChartScatter, ClipboardCheck, Palette } from "lucide-react";
import type { ReactNode } from "react";
import { useHasRole } from "../../../app/session/MeContext";
import { Button, IconButton, Segmented, Select } from "../../../components";
import { count } from "../../../components/numbers";
import { SHOWN_WORDS } from "../grid/stateWords";
import { ordersQuery } from "../rows/tableQueries";
import { type Panel, SHOWN, TILE_SIZES, type TileSize } from "../view/tableView";
import type { TableViewState } from "../view/useTableView";
import styles from "./Toolbar.module.css";

const SIZE_WORDS: Readonly<Record<TileSize, string>> = { s: "Small", m: "Medium", l: "Large" };
const NO_ORDER = "none";

export interface TableToolbarProps {
  readonly collectionId: number;
  readonly state: TableViewState;
  readonly nShapes: number | null;
}

/** What is shown, in which order, how large, and which panel is beside it. */
export function TableToolbar({ collectionId, state, nShapes }: TableToolbarProps) {
  const { view, change } = state;
  const isReviewer = useHasRole("reviewer");
  const toggle = (panel: Panel) => change({ panel: view.panel === panel ? null : panel });
  return (
    <div className={styles.bar} role="toolbar" aria-label="Table">
      <Select
        label="Labels shown"
        isLabelUnseen
        title="Labels shown"
        value={view.shown}
        options={SHOWN.map((shown) => ({ value: shown, label: SHOWN_WORDS[shown] }))}
        onChange={(shown) => change({ shown })}
      />
      <OrderMenu collectionId={collectionId} state={state} />
      <p className={styles.total} role="status">
        {nShapes === null ? "" : count(nShapes, "shape")}
      </p>
      <span className={styles.space} />
      <Segmented
        label="Size of pictures"
        size="small"
        value={view.size}
        options={TILE_SIZES.map((size) => ({
          value: size,
          label: SIZE_WORDS[size],
          icon: <span aria-hidden="true">{size.toUpperCase()}</span>,
        }))}
        onChange={(size) => change({ size }, true)}
      />
      <PanelButton isOpen={view.panel === "map"} icon={<ChartScatter />} onClick={() => toggle("map")}>
        Map
      </PanelButton>
      <PanelButton isOpen={view.panel === "parts"} icon={<Palette />} onClick={() => toggle("parts")}>
        Parts
      </PanelButton>
      {isReviewer && (
        <PanelButton
          isOpen={view.panel === "reviews"}
          icon={<ClipboardCheck />}
          onClick={() => toggle("reviews")}
        >
          Reviews
        </PanelButton>
      )}
    </div>
  );
}

function PanelButton(props: { isOpen: boolean; icon: ReactNode; onClick: () => void; children: string }) {
  const { isOpen, children, ...rest } = props;
  return (
    <Button
      size="small"
      variant={isOpen ? "secondary" : "quiet"}
      aria-pressed={isOpen}
      title={children}
      {...rest}
    >
      <span className={styles.panelName}>{children}</span>
    </Button>
  );
}

function OrderMenu({ collectionId, state }: { collectionId: number; state: TableViewState }) {
  const { view, change } = state;
  const orders = useQuery(ordersQuery(collectionId)).data?.items ?? [{ name: NO_ORDER, label: "None" }];
  const known = orders.some((each) => each.name === (view.order ?? NO_ORDER));
  const options =
    known || view.order === null ? orders : [...orders, { name: view.order, label: view.order }];
  const choose = (name: string) => {
    const order = options.find((each) => each.name === name);
    const isDescending =
      order !== undefined && "direction_default" in order && order.direction_default === "desc";
    change({ order: name === NO_ORDER ? null : name, descending: isDescending });
  };
  return (
    <span className={styles.order}>
      <Select
        label="Order by"
        isLabelUnseen
        title="Order by"
        value={view.order ?? NO_ORDER}
        options={options.map(({ name, label }) => ({
          value: name,
          label:
            name === NO_ORDER
              ? "No order"
              : `By ${label.toLowerCase() === label ? label : lowerFirst(label)}`,
        }))}
        onChange={choose}
      />
      <IconButton
        label={view.descending ? "Highest first; show lowest first" : "Lowest first; show highest first"}
        icon={view.descending ? <ArrowDownNarrowWide className={styles.down} /> : <ArrowUpNarrowWide />}
        onClick={() => change({ descending: !view.descending })}
      />
    </span>
  );
}

/** "Entropy by area" within a sentence; "BALD" as it is. */
function lowerFirst(label: string): string {
  return /^[A-Z]{2}/.test(label) ? label : label.charAt(0).toLowerCase() + label.slice(1);
}
