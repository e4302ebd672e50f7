import { RoomHeading } from "../../app/RoomHeading";
import type { RoomProps } from "../../app/rooms";

export function SettingsRoom({ collectionId }: RoomProps) {
  return <RoomHeading title="Settings">{`Settings of collection ${collectionId}`}</RoomHeading>;
}
