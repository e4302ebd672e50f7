/** Light, dark, or as the system has it: kept in this browser, and on the document, where the tokens read it. */

export const SCHEMES = ["system", "light", "dark"] as const;
export type Scheme = (typeof SCHEMES)[number];

const KEY = "partwise.scheme";

export function savedScheme(storage: Storage): Scheme {
  const saved = storage.getItem(KEY);
  return SCHEMES.find((each) => each === saved) ?? "system";
}

export function applyScheme(scheme: Scheme, root: HTMLElement): void {
  if (scheme === "system") delete root.dataset.scheme;
  else root.dataset.scheme = scheme;
}

export function saveScheme(scheme: Scheme, storage: Storage): void {
  if (scheme === "system") storage.removeItem(KEY);
  else storage.setItem(KEY, scheme);
}
