/** Keeps to the parts that the collection has now: in what may be painted, and in the settings of the tools. */
import { useEffect } from "react";
import { useObservable } from "../../../drafts/useObservable";
import { UNLABELLED } from "../../../labels/operations";
import type { Part } from "../parts";
import type { OpenShape } from "../shape/openShape";
import type { ToolShelf } from "./toolSettings";

export function useKnownParts(shelf: ToolShelf, open: OpenShape | null, parts: readonly Part[]): void {
  const { part, onlyOver } = useObservable(shelf.settings);
  useEffect(() => {
    if (parts.length > 0) open?.setParts(parts.map(({ id }) => id));
  }, [open, parts]);
  useEffect(() => {
    const [first] = parts;
    const isKnown = (id: number) => id === UNLABELLED || parts.some((each) => each.id === id);
    if (first === undefined) return;
    if (!isKnown(part)) shelf.change({ part: first.id });
    if (onlyOver !== null && !isKnown(onlyOver)) shelf.change({ onlyOver: null });
  }, [shelf, parts, part, onlyOver]);
}
