/** Time and chance, so that tests decide about both. */

export interface Clock {
  /** Milliseconds since 1970. */
  now(): number;
  /** Calls `task` after `delayMs`; the function it returns calls that off. */
  after(delayMs: number, task: () => void): () => void;
  /** At least 0 and below 1. */
  random(): number;
}

export const systemClock: Clock = {
  now: () => Date.now(),
  after: (delayMs, task) => {
    const timer = setTimeout(task, delayMs);
    return () => clearTimeout(timer);
  },
  random: () => Math.random(),
};
