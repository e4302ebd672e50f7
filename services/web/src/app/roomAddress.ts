/** Where rooms are, for links to them from anywhere. */

/** A collection, a room of it, and what a room may add. */
export const ROOM_ADDRESS = /^\/c\/(?<collectionId>\d+)(?:\/(?<room>[^/]+))?(?:\/.*)?$/;

/** What a room learns from its address. */
export interface RoomProps {
  collectionId: number;
}

/** path : the room's place in addresses: /c/3/table. */
export function roomAddress(collectionId: number, path: string): string {
  return `/c/${collectionId}/${path}`;
}
