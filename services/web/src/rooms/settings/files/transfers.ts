/** Files that are being sent: a list that only these actions change. */

export interface Transfer {
  id: number;
  name: string;
  nBytes: number;
  nSent: number;
  state: "waiting" | "sending" | "sent" | "failed" | "cancelled";
  /** Why it failed, and what to do. */
  error: string | null;
}

export type TransferAction =
  | { kind: "add"; transfers: readonly Transfer[] }
  | { kind: "change"; id: number; change: Partial<Transfer> }
  | { kind: "clear" };

export function transfersAfter(transfers: readonly Transfer[], action: TransferAction): readonly Transfer[] {
  switch (action.kind) {
    case "add":
      return [...transfers, ...action.transfers];
    case "change":
      return transfers.map((each) => (each.id === action.id ? { ...each, ...action.change } : each));
    case "clear":
      return transfers.filter(isUnderWay);
  }
}

export function isUnderWay({ state }: Transfer): boolean {
  return state === "waiting" || state === "sending";
}

const KNOWN = [".off", ".obj", ".ply", ".stl", ".glb", ".zip", ".tar.gz", ".tgz"] as const;

/** What the picker offers. The service decides by what is in a file. */
export const ACCEPTED = [...KNOWN, ".gz"].join(",");

export function isKnownFile(name: string): boolean {
  return KNOWN.some((suffix) => name.toLowerCase().endsWith(suffix));
}
