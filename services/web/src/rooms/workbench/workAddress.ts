import { roomAddress } from "../../app/roomAddress";

/** Where these shapes are worked on; up to four at once. */
export function workAddress(collectionId: number, shapeIds: readonly number[]): string {
  return `${roomAddress(collectionId, "work")}?shapes=${shapeIds.join(",")}`;
}
