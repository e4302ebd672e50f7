// @vitest-environment jsdom
import { act, cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { NameSearch } from "./NameSearch";

const onSearch = vi.fn();
const LONG_MS = 1_000;

beforeEach(() => {
  vi.useFakeTimers();
  onSearch.mockClear();
});
afterEach(() => {
  cleanup();
  vi.useRealTimers();
});

function box(): HTMLInputElement {
  return screen.getByRole("textbox", { name: "Search names" });
}

function type(text: string): void {
  fireEvent.change(box(), { target: { value: text } });
}

function rest(): void {
  act(() => void vi.advanceTimersByTime(LONG_MS));
}

it("asks once the typing rests, for what is left without spaces around it", () => {
  render(<NameSearch name={null} onSearch={onSearch} />);
  type("cha");
  type(" chair ");
  expect(onSearch).not.toHaveBeenCalled();
  rest();
  expect(onSearch.mock.calls).toEqual([["chair"]]);
});

it("asks at once on Enter, and no second time", () => {
  render(<NameSearch name={null} onSearch={onSearch} />);
  type("chair");
  fireEvent.keyDown(box(), { key: "Enter" });
  rest();
  expect(onSearch.mock.calls).toEqual([["chair"]]);
});

it("asks for any name on Escape", () => {
  render(<NameSearch name="chair" onSearch={onSearch} />);
  fireEvent.keyDown(box(), { key: "Escape" });
  rest();
  expect(box().value).toBe("");
  expect(onSearch.mock.calls).toEqual([[null]]);
});

it("shows what the address has come to, and asks nothing", () => {
  const { rerender } = render(<NameSearch name="chair" onSearch={onSearch} />);
  rerender(<NameSearch name="stool" onSearch={onSearch} />);
  rest();
  expect(box().value).toBe("stool");
  expect(onSearch).not.toHaveBeenCalled();
});

it("has the focus after a slash, unless that is text", () => {
  render(
    <>
      <textarea aria-label="Note" />
      <NameSearch name={null} onSearch={onSearch} />
    </>,
  );
  screen.getByLabelText("Note").focus();
  fireEvent.keyDown(screen.getByLabelText("Note"), { key: "/" });
  expect(document.activeElement).not.toBe(box());
  fireEvent.keyDown(document.body, { key: "/" });
  expect(document.activeElement).toBe(box());
});
