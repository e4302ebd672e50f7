/** The names in a text with one a line: without blanks around them, empty lines and repetitions. */
export function partNamesOf(text: string): readonly string[] {
  const names = text.split("\n").map((line) => line.trim());
  return [...new Set(names.filter((name) => name !== ""))];
}
