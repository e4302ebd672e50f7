/** What a button does that takes a while: once at a time, and what goes wrong is told. */
import { useCallback, useRef, useState } from "react";
import { useToast } from "../../../components";

export interface RunningTask {
  readonly isBusy: boolean;
  /** Does nothing while one is under way: a double click is one click. */
  run(task: () => Promise<void>): void;
}

export function useTask(): RunningTask {
  const showToast = useToast();
  const [isBusy, setBusy] = useState(false);
  const isRunning = useRef(false);
  const run = useCallback(
    async (task: () => Promise<void>) => {
      if (isRunning.current) return;
      isRunning.current = true;
      setBusy(true);
      try {
        await task();
      } catch (error) {
        showToast({ message: error instanceof Error ? error.message : String(error), tone: "bad" });
      } finally {
        isRunning.current = false;
        setBusy(false);
      }
    },
    [showToast],
  );
  return { isBusy, run: (task) => void run(task) };
}
