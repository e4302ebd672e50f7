import type { Schemas } from "../../api/client";

export type Part = Schemas["PartOut"];

/** How labels without a part are called. */
export const UNLABELLED_NAME = "Unlabelled";
const N_KEYS = 20;

/** The key that picks the part at a place of the list; null past the twentieth. */
export function keyOfPart(place: number): string | null {
  if (place >= N_KEYS) return null;
  const digit = (place + 1) % 10;
  return place < 10 ? String(digit) : `⇧${digit}`;
}
