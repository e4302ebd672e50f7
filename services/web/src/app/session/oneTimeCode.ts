/** One-time codes: `#code=…` behind the page's address, as the service prints it when it starts. */

const FRAGMENT = /^#code=(.+)$/;

/** The code in a fragment, or null. */
export function codeOfFragment(fragment: string): string | null {
  const found = FRAGMENT.exec(fragment)?.[1];
  return found === undefined ? null : decodeURIComponent(found);
}

/** Takes the code out of the address, at once, so that it stays in no history, bookmark or picture of the screen. */
export function takeOneTimeCode(window: Window): string | null {
  const code = codeOfFragment(window.location.hash);
  if (code !== null)
    window.history.replaceState(window.history.state, "", window.location.pathname + window.location.search);
  return code;
}
