import type { Query, QueryClient } from "@tanstack/react-query";
import { meQuery } from "../../api/queries";
import { announceSessionBegin } from "../../api/sessionEnd";
import { isKeptInPlace } from "../events/invalidation";
import type { Me } from "./session";

/** Goes on as whoever logged in: what was read for somebody else is forgotten, what failed meanwhile is read anew. */
export function enterAs(queries: QueryClient, me: Me): void {
  const before = queries.getQueryData(meQuery.queryKey);
  const isOther = before !== undefined && before.person_id !== me.person_id;
  if (isOther) queries.removeQueries({ predicate: (each) => each.queryKey[0] !== "me" });
  queries.setQueryData(meQuery.queryKey, me);
  announceSessionBegin();
  const mayDiffer = (each: Query) => each.queryKey[0] !== "me" && !isKeptInPlace(each);
  if (!isOther) void queries.invalidateQueries({ predicate: mayDiffer });
}
