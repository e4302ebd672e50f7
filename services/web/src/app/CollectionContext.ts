import { createContext, useContext } from "react";
import type { Schemas } from "../api/client";

export type Collection = Schemas["CollectionOut"];

export const CollectionContext = createContext<Collection | null>(null);

/** The collection that the address names. Rooms are only shown for one that exists. */
export function useCollection(): Collection {
  const collection = useContext(CollectionContext);
  if (collection === null) throw new Error("useCollection needs a collection in the address");
  return collection;
}
