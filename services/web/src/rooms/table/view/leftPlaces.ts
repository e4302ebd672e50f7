/** Where lists were left in this tab, so that coming back to one, by whichever way, is coming back to the place. */
import type { RowList } from "../rows/tableQueries";

/** Places in the list. first : the first one in view. cursor : where the keyboard is. */
export interface LeftPlace {
  readonly first: number;
  readonly cursor: number;
}

const BEGINNING: LeftPlace = { first: 0, cursor: 0 };

/** The same for a list that is read anew. */
export const listName = ({ collectionId, filters, order, descending }: RowList) =>
  JSON.stringify([collectionId, filters, order, descending]);

export function rememberPlace(list: RowList, place: LeftPlace): void {
  sessionStorage.setItem(keyOf(list), JSON.stringify([place.first, place.cursor]));
}

export function leftPlace(list: RowList): LeftPlace {
  const kept = sessionStorage.getItem(keyOf(list));
  if (kept === null) return BEGINNING;
  const [first, cursor] = JSON.parse(kept);
  return { first, cursor };
}

function keyOf(list: RowList): string {
  return `place in list ${listName(list)}`;
}
