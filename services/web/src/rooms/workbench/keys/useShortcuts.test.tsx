// @vitest-environment jsdom
import { cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { WorkbenchActions } from "./shortcuts";
import { useShortcuts } from "./useShortcuts";

const useTool = vi.fn();

function Bench() {
  useShortcuts({ useTool } as unknown as WorkbenchActions);
  return (
    <select aria-label="Only over">
      <option>Anything</option>
      <option>Back</option>
    </select>
  );
}

beforeEach(() => {
  useTool.mockClear();
  render(<Bench />);
});
afterEach(cleanup);

it("are keys again after a choice from a list", () => {
  const select = screen.getByLabelText("Only over");
  fireEvent.mouseDown(select);
  select.focus();
  fireEvent.change(select, { target: { value: "Back" } });
  fireEvent.keyDown(document.activeElement ?? document.body, { key: "b" });
  expect(useTool).toHaveBeenCalledWith("paint");
});

it("stay with a list that was come to by keys, which choose of it", () => {
  const select = screen.getByLabelText("Only over");
  fireEvent.mouseDown(select); // nothing was chosen then
  fireEvent.keyDown(select, { key: "Tab" });
  select.focus();
  fireEvent.change(select, { target: { value: "Back" } });
  expect(document.activeElement).toBe(select);
  fireEvent.keyDown(select, { key: "b" });
  expect(useTool).not.toHaveBeenCalled();
});
