/** What ends a stage that fails, and what to do about it. */
import type { FailureKind } from "../queries";

export const FAILURE_WORDS: Readonly<Record<FailureKind, { name: string; advice: string }>> = {
  error: {
    name: "Refused",
    advice: "The shape was refused, or nobody foresaw what happened: read the reason.",
  },
  deadline: {
    name: "Too slow",
    advice: "It took longer than it may. Try again when the machine has less to do.",
  },
  memory: {
    name: "Out of memory",
    advice: "It needed more memory than it may. Give workers more, then try again.",
  },
  crash: {
    name: "Crashed",
    advice: "Its process died by itself. Try again; if it does so again, look at the log.",
  },
};
