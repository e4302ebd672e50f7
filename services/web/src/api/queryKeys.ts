/** What answers are about: the first word of every query's key, so that whoever says they are stale names some there are. */
import "@tanstack/react-query";

export const ABOUT = [
  "accepts",
  "audit",
  "collections",
  "counts",
  "embedding",
  "failures",
  "ingest prefixes",
  "jobs",
  "leases",
  "map",
  "map look",
  "map progress",
  "me",
  "models",
  "ops",
  "ops history",
  "ops people",
  "orders",
  "parts",
  "people",
  "reviews",
  "rounds",
  "rows",
  "shape",
  "skips",
  "tokens",
  "uploads",
] as const;
export type About = (typeof ABOUT)[number];

/** Second is the id of the collection, or of the shape, where an answer is about one. */
declare module "@tanstack/react-query" {
  interface Register {
    queryKey: readonly [About, ...unknown[]];
  }
}
