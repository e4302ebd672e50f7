import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { onScreen } from "./onScreen";

let frames: FrameRequestCallback[];

beforeEach(() => {
  frames = [];
  vi.useFakeTimers();
  vi.stubGlobal("requestAnimationFrame", (frame: FrameRequestCallback) => frames.push(frame));
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

it("what was drawn shows a frame later", async () => {
  const ended = vi.fn();
  void onScreen(Promise.resolve()).then(ended);
  await vi.advanceTimersByTimeAsync(0);
  frames.shift()?.(0);
  await vi.advanceTimersByTimeAsync(0);
  expect(ended).not.toHaveBeenCalled();
  frames.shift()?.(16);
  await vi.advanceTimersByTimeAsync(0);
  expect(ended).toHaveBeenCalled();
});

it("nobody waits for ever for what is not drawn", async () => {
  const ended = vi.fn();
  void onScreen(new Promise(() => {})).then(ended);
  await vi.advanceTimersByTimeAsync(500);
  expect(ended).not.toHaveBeenCalled();
  await vi.advanceTimersByTimeAsync(500);
  expect(ended).toHaveBeenCalled();
});
