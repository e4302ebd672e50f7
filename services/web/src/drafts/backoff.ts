/** Waits that double from try to try, each shortened at random so that many clients do not come back at once. */
import type { Clock } from "./clock";

const FIRST_MS = 500;
const LONGEST_MS = 30_000;

export class Backoff {
  private failures = 0;
  private cancel: (() => void) | null = null;

  constructor(private readonly clock: Clock) {}

  /** Calls `task` after the next wait, instead of what waits already. */
  wait(task: () => void): void {
    const delayMs = Math.min(LONGEST_MS, FIRST_MS * 2 ** this.failures);
    this.failures++;
    this.cancel?.();
    this.cancel = this.clock.after(delayMs * (0.5 + this.clock.random() / 2), () => {
      this.cancel = null;
      task();
    });
  }

  /** Calls off what waits. */
  stop(): void {
    this.cancel?.();
    this.cancel = null;
  }

  /** It worked: the next wait is a short one again. */
  reset(): void {
    this.failures = 0;
    this.stop();
  }
}
