/** Whether keys are text where the focus is. */
export function isTyping(target: EventTarget | null): boolean {
  return (
    target instanceof Element &&
    target.closest(
      "input:not([type=range],[type=checkbox],[type=radio]), textarea, select, [contenteditable]",
    ) !== null
  );
}
