/** What the map is told, and tells, of the list beside it. */
export interface MapPanelProps {
  readonly collectionId: number;
  /** Ids of the shapes that are selected beside the map. */
  readonly chosen: ReadonlySet<number>;
  /** The cluster that the list is limited to. */
  readonly cluster: number | null;
  /** Whether the person may say what comes first in the queue. */
  readonly mayOrder: boolean;
  onChoose(shapeIds: readonly number[], isAdding: boolean): void;
  /** One shape was picked, for the list to show where it is. */
  onShow?(shapeId: number): void;
  onCluster(cluster: number | null): void;
}
