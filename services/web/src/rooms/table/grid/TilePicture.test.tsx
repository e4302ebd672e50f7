// @vitest-environment jsdom
import { act, cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { TilePicture } from "./TilePicture";

/** Pictures that were asked for beside the page. */
let asked: HTMLImageElement[] = [];

beforeEach(() => {
  vi.useFakeTimers();
  asked = [];
  vi.stubGlobal("Image", function image() {
    const made = document.createElement("img");
    asked.push(made);
    return made;
  });
});
afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

const shown = () => document.querySelector<HTMLImageElement>("img");
const pass = (ms: number) => act(() => void vi.advanceTimersByTime(ms));

it("stands in for a picture that is not there, and shows it once it is", () => {
  render(<TilePicture address="/picture" isFailed={false} />);
  fireEvent.error(shown() as HTMLImageElement);
  expect(screen.getByText("No picture yet")).toBeTruthy();
  pass(4_000);
  act(() => void asked.at(-1)?.onerror?.(new Event("error")));
  pass(4_000);
  expect(asked.at(-1)?.getAttribute("src")).toBeNull(); // it waits longer from try to try
  pass(4_000);
  expect(asked.at(-1)?.getAttribute("src")).toBe("/picture");
  act(() => void asked.at(-1)?.onload?.(new Event("load")));
  expect(shown()?.getAttribute("src")).toBe("/picture");
});

it("asks no more once the tile is gone", () => {
  const { unmount } = render(<TilePicture address="/picture" isFailed={false} />);
  fireEvent.error(shown() as HTMLImageElement);
  unmount();
  pass(60_000);
  expect(asked.every((each) => each.getAttribute("src") === null)).toBe(true);
});
