/**
 * Tells the page that the service no longer knows who it is talking to, and that it does again.
 *
 * The window carries the news, so that whatever talks to the service need not know who shows the login.
 */

const ENDED = "partwise:session-ended";
const BEGUN = "partwise:session-begun";

export function announceSessionEnd(): void {
  window.dispatchEvent(new Event(ENDED));
}

export function announceSessionBegin(): void {
  window.dispatchEvent(new Event(BEGUN));
}

/** Calls back whenever an answer says that the session is over. Returns what stops it. */
export function onSessionEnd(listener: () => void): () => void {
  window.addEventListener(ENDED, listener);
  return () => window.removeEventListener(ENDED, listener);
}

/** Calls back once somebody has logged in again, such as to send what is queued. Returns what stops it. */
export function onSessionBegin(listener: () => void): () => void {
  window.addEventListener(BEGUN, listener);
  return () => window.removeEventListener(BEGUN, listener);
}
