/** Waits for the screen, so that what comes next takes no time from it. */

/** For shapes that are not drawn for now: loaded ahead, or in a tab that nobody looks at. */
const PATIENCE_MS = 1_000;

/** Ends once a frame that was drawn shows, which takes a while after its drawing was asked for; or after a while. */
export function onScreen(drawn: Promise<void>): Promise<void> {
  return new Promise((resolve) => {
    const patience = setTimeout(resolve, PATIENCE_MS);
    const end = () => {
      clearTimeout(patience);
      resolve();
    };
    // browsers begin no further frames before those that wait are drawn
    void drawn.then(() => requestAnimationFrame(() => requestAnimationFrame(end)));
  });
}
