/** Whether a dialog or a menu is open, so that keys are its own. */
export function hasOverlay(): boolean {
  return document.querySelector("dialog[open], [aria-haspopup=menu][aria-expanded=true]") !== null;
}
