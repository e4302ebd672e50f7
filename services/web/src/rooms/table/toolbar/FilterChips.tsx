import { useQuery } from "@tanstack/react-query";
import { partsQuery } from "../../../api/queries";
import { useHasRole, useMe } from "../../../app/session/MeContext";
import { Button } from "../../../components";
import { STATE_WORDS, stageWords } from "../grid/stateWords";
import { peopleQuery } from "../rows/tableQueries";
import { countFilters, NO_FILTERS, type ShapeFilters, STATES } from "../view/tableView";
import { FilterChip, type FilterOption } from "./FilterChip";
import { NameSearch } from "./NameSearch";
import styles from "./Toolbar.module.css";

/** Stages that can fail, in the order in which shapes go through them. */
const STAGES = ["any", "mesh", "remesh", "describe", "picture", "evaluate", "refine"] as const;

export interface FilterChipsProps {
  readonly collectionId: number;
  readonly filters: ShapeFilters;
  onFilter(part: Partial<ShapeFilters>, isPassing?: boolean): void;
}

/** What shapes must meet to be shown: a menu for each, which says how many there would be. */
export function FilterChips({ collectionId, filters, onFilter }: FilterChipsProps) {
  const parts = useQuery(partsQuery(collectionId)).data?.parts ?? [];
  const people = usePeople();
  const about = { collectionId, filters };
  return (
    <search className={styles.filters} aria-label="Filters">
      <NameSearch name={filters.name} onSearch={(name) => onFilter({ name }, true)} />
      <FilterChip
        {...about}
        label="State"
        value={filters.state}
        options={STATES.map((state) => option(state, STATE_WORDS[state], { state }))}
        onChoose={(state) => onFilter({ state })}
      />
      <FilterChip
        {...about}
        label="Part"
        value={filters.part}
        options={parts.map(({ id, name, colour }) => ({ ...option(id, name, { part: id }), colour }))}
        onChoose={(part) => onFilter({ part })}
      />
      <FilterChip
        {...about}
        label="Author"
        value={filters.author}
        options={people.map(({ id, name }) => option(id, name, { author: id }))}
        onChoose={(author) => onFilter({ author })}
      />
      <FilterChip
        {...about}
        label="Failed at"
        value={filters.failed}
        options={STAGES.map((stage) => option(stage, capital(stageWords(stage)), { failed: stage }))}
        onChoose={(failed) => onFilter({ failed })}
      />
      {filters.cluster !== null && (
        <FilterChip
          {...about}
          label="Cluster"
          value={filters.cluster}
          options={[option(filters.cluster, String(filters.cluster + 1), { cluster: filters.cluster })]}
          onChoose={(cluster) => onFilter({ cluster })}
        />
      )}
      {countFilters(filters) > 1 && (
        <Button size="small" variant="quiet" onClick={() => onFilter(NO_FILTERS)}>
          Clear filters
        </Button>
      )}
    </search>
  );
}

function option<T>(value: T, label: string, filters: Partial<ShapeFilters>): FilterOption<T> {
  return { value, label, filters };
}

function capital(words: string): string {
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** Whose labels one may look for: reviewers see who there is, all others themselves. */
function usePeople(): readonly { id: number; name: string }[] {
  const me = useMe();
  const maySee = useHasRole("reviewer");
  const people = useQuery({ ...peopleQuery, enabled: maySee }).data?.items;
  return people ?? [{ id: me.person_id, name: `${me.name} (you)` }];
}
