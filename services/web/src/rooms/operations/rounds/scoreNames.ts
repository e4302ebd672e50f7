/** What scores are called. */
const NAMES: Readonly<Record<string, string>> = {
  entropy: "entropy",
  bald: "BALD",
};

export function scoreName(name: string): string {
  return NAMES[name.toLowerCase()] ?? (name === "" ? "score" : name);
}
