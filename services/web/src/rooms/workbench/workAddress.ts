/** The workbench's part of addresses: which shapes are asked for by name. */
import { roomAddress } from "../../app/rooms";

/** Where these shapes are worked on; up to four at once. */
export function workAddress(collectionId: number, shapeIds: readonly number[]): string {
  return `${roomAddress(collectionId, "work")}?shapes=${shapeIds.join(",")}`;
}

/** Shapes that an address's query asks for. */
export function namedShapes(search: string): number[] {
  const ids = (new URLSearchParams(search).get("shapes") ?? "").split(",").map(Number);
  return ids.filter((id) => Number.isSafeInteger(id) && id > 0);
}
