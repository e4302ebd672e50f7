/** Whether a token is still good. */
import type { Token } from "./queries";

export type TokenState = "good" | "expired" | "revoked";

export function tokenState(
  { revoked_at, expires_at }: Pick<Token, "revoked_at" | "expires_at">,
  nowMs: number,
): TokenState {
  if (revoked_at !== null) return "revoked";
  return Date.parse(expires_at) <= nowMs ? "expired" : "good";
}
