import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Soon } from "./Soon";

beforeEach(() => vi.useFakeTimers());
afterEach(() => vi.useRealTimers());

it("acts once for all that asked", () => {
  const act = vi.fn();
  const soon = new Soon(act);
  soon.within(400);
  soon.within(400);
  vi.advanceTimersByTime(1_000);
  expect(act).toHaveBeenCalledOnce();
});

it("acts when the most urgent wants it", () => {
  const act = vi.fn();
  const soon = new Soon(act);
  soon.within(2_500);
  soon.within(400);
  vi.advanceTimersByTime(400);
  expect(act).toHaveBeenCalledOnce();
});

it("acts again when it is asked again", () => {
  const act = vi.fn();
  const soon = new Soon(act);
  soon.within(400);
  vi.advanceTimersByTime(400);
  soon.within(400);
  vi.advanceTimersByTime(400);
  expect(act).toHaveBeenCalledTimes(2);
});

it("acts no more once it is stopped", () => {
  const act = vi.fn();
  const soon = new Soon(act);
  soon.within(400);
  soon.stop();
  vi.advanceTimersByTime(1_000);
  expect(act).not.toHaveBeenCalled();
});
