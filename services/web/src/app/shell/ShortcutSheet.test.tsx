// @vitest-environment jsdom
import { cleanup, render, screen } from "@testing-library/react";
import { afterEach, beforeAll, expect, it } from "vitest";
import { MeContext } from "../session/MeContext";
import type { Me } from "../session/session";
import { ShortcutSheet } from "./ShortcutSheet";

beforeAll(() => {
  HTMLDialogElement.prototype.showModal ??= function show(this: HTMLDialogElement) {
    this.open = true;
  };
  HTMLDialogElement.prototype.close ??= () => undefined;
});
afterEach(cleanup);

function headings(room: string | null, role: Me["role"] = "annotator"): (string | null)[] {
  render(
    <MeContext.Provider value={{ role } as Me}>
      <ShortcutSheet room={room} onClose={() => undefined} />
    </MeContext.Provider>,
  );
  return screen.getAllByRole("heading", { level: 3 }).map((heading) => heading.textContent);
}

it("tells the keys of the table and of its map to who is there", () => {
  expect(headings("table")).toEqual(["Among shapes", "On the map", "Rooms", "Anywhere"]);
  expect(screen.getByText("Ctrl+A")).toBeDefined();
});

it("tells what works in every room elsewhere", () => {
  expect(headings("operations")).toEqual(["Rooms", "Anywhere"]);
});

it("tells of the rooms that the person may enter how to get there", () => {
  headings("table", "annotator");
  const row = screen.getByText("Workbench").parentElement;
  expect(row?.textContent).toBe("WorkbenchG then W");
  expect(screen.queryByText("Settings")).toBeNull();
});
