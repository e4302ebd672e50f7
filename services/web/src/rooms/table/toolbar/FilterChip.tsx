import { useQuery } from "@tanstack/react-query";
import { ChevronDown, X } from "lucide-react";
import { classes, IconButton, Menu, MenuChoice, MenuItem, MenuLine } from "../../../components";
import { short, whole } from "../../../components/numbers";
import { countQuery } from "../rows/tableQueries";
import type { ShapeFilters } from "../view/tableView";
import styles from "./Toolbar.module.css";

export interface FilterOption<T> {
  readonly value: T;
  readonly label: string;
  /** What choosing it sets. */
  readonly filters: Partial<ShapeFilters>;
  readonly colour?: string;
}

export interface FilterChipProps<T> {
  readonly collectionId: number;
  readonly filters: ShapeFilters;
  readonly label: string;
  readonly value: T | null;
  readonly options: readonly FilterOption<T>[];
  onChoose(value: T | null): void;
}

/** One filter: a menu while it is not set, and what it is set to, with a cross, once it is. */
export function FilterChip<T extends string | number>(props: FilterChipProps<T>) {
  const { collectionId, filters, label, value, options, onChoose } = props;
  const chosen = options.find((each) => each.value === value);
  const isSet = value !== null;
  return (
    <span className={classes(styles.chip, isSet && styles.set)}>
      <Menu
        label={`Filter by ${label.toLowerCase()}`}
        className={styles.chipButton}
        trigger={
          <>
            <span>{isSet ? `${label}: ${chosen?.label ?? value}` : label}</span>
            {!isSet && <ChevronDown aria-hidden="true" />}
          </>
        }
      >
        {options.length === 0 && (
          <MenuItem isDisabled onSelect={() => undefined}>
            None yet
          </MenuItem>
        )}
        {options.map((each) => (
          <MenuChoice
            key={each.value}
            isChecked={each.value === value}
            onSelect={() => onChoose(each.value === value ? null : each.value)}
            icon={each.colour && <span className={styles.swatch} style={{ background: each.colour }} />}
          >
            <span className={styles.optionWords}>
              {each.label}
              <OptionCount collectionId={collectionId} filters={{ ...filters, ...each.filters }} />
            </span>
          </MenuChoice>
        ))}
        {isSet && (
          <>
            <MenuLine />
            <MenuItem onSelect={() => onChoose(null)}>Any</MenuItem>
          </>
        )}
      </Menu>
      {isSet && (
        <IconButton
          size="small"
          className={styles.chipCross ?? ""}
          label={`Show any ${label.toLowerCase()}`}
          icon={<X />}
          onClick={() => onChoose(null)}
        />
      )}
    </span>
  );
}

/** How many shapes there would be. Menus render what is in them while they are open, so nothing is counted before. */
function OptionCount({ collectionId, filters }: { collectionId: number; filters: ShapeFilters }) {
  const { data } = useQuery(countQuery(collectionId, filters));
  return (
    <span className={styles.count} title={data === undefined ? undefined : whole(data)}>
      {data === undefined ? "…" : short(data)}
    </span>
  );
}
