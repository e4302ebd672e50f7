/** What people paste to log in: a token, or the address with a one-time code. */
import type { Schemas } from "../../api/client";
import { codeOfFragment } from "./oneTimeCode";

export type Credential = Schemas["CodeLogin"] | Schemas["TokenLogin"];

/** The credential in a pasted text, or null if it holds none. */
export function credentialOf(pasted: string): Credential | null {
  const text = pasted.trim();
  if (text === "") return null;
  const fragment = text.indexOf("#");
  const code = fragment < 0 ? null : codeOfFragment(text.slice(fragment));
  return code === null ? { token: text } : { code };
}
