import { RoomHeading } from "../../app/RoomHeading";
import type { RoomProps } from "../../app/rooms";

export function WorkbenchRoom({ collectionId }: RoomProps) {
  return <RoomHeading title="Workbench">{`Workbench of collection ${collectionId}`}</RoomHeading>;
}
