import { RoomHeading } from "../../app/RoomHeading";
import type { RoomProps } from "../../app/rooms";

export function OperationsRoom({ collectionId }: RoomProps) {
  return <RoomHeading title="Operations">{`Operations of collection ${collectionId}`}</RoomHeading>;
}
