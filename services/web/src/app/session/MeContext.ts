import { createContext, useContext } from "react";
import { hasRole, type Me, type Role } from "./session";

export const MeContext = createContext<Me | null>(null);

/** Who uses the page. Rooms are only shown to somebody who is logged in. */
export function useMe(): Me {
  const me = useContext(MeContext);
  if (me === null) throw new Error("useMe needs somebody to be logged in");
  return me;
}

/** Whether the person who uses the page has at least this role. */
export function useHasRole(role: Role): boolean {
  return hasRole(useMe(), role);
}
