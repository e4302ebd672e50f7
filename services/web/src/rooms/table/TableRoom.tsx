import { RoomHeading } from "../../app/RoomHeading";
import type { RoomProps } from "../../app/rooms";

export function TableRoom({ collectionId }: RoomProps) {
  return <RoomHeading title="Table">{`Table of collection ${collectionId}`}</RoomHeading>;
}
