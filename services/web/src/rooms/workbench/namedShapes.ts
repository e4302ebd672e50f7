/** Shapes that an address's query asks for. */
export function namedShapes(search: string): number[] {
  const ids = (new URLSearchParams(search).get("shapes") ?? "").split(",").map(Number);
  return ids.filter((id) => Number.isSafeInteger(id) && id > 0);
}
