import type { ShapeRow } from "../rows/shapeRows";
import type { OutcomeTeller } from "./useOutcome";

/** What each dialog of an action gets. rows : the shapes that it is about, as they were when it was opened. */
export interface ShapeActionProps {
  readonly collectionId: number;
  readonly rows: ReadonlyMap<number, ShapeRow>;
  readonly teller: OutcomeTeller;
  /** These may have another state now, or were refused it. */
  onActed(shapeIds: readonly number[]): void;
  onClose(): void;
}
