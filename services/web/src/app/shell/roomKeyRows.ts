import { ROOMS } from "../rooms";
import { hasRole, type Me } from "../session/session";
import type { KeyRow } from "./KeyGroup";

/** The keys that lead to the rooms which somebody may enter, for sheets. */
export function roomKeyRows(me: Me): readonly KeyRow[] {
  return ROOMS.filter(({ role }) => hasRole(me, role)).map(({ path, name }) => [
    `G then ${path.charAt(0).toUpperCase()}`,
    name,
  ]);
}
