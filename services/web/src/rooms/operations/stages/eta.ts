/** When a stage will be through, if it goes on as it did lately. */
export function etaInSeconds(nLeft: number, perMin: number): number | null {
  if (nLeft <= 0 || perMin <= 0) return null;
  return (nLeft / perMin) * 60;
}
