// @vitest-environment jsdom
import { cleanup, fireEvent, render, screen } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Router } from "wouter";
import { memoryLocation } from "wouter/memory-location";
import { Menu } from "../../components";
import { MeContext } from "../session/MeContext";
import type { Me } from "../session/session";
import { useRoomKeys } from "./useRoomKeys";

const AT_WORK = "/c/3/work";
const ownKey = vi.fn();
let location: ReturnType<typeof memoryLocation> & { history: string[] };

function Keys() {
  useRoomKeys(3, "work");
  return null;
}

function atWork(room: ReactNode = null, role: Me["role"] = "operator"): void {
  render(
    <MeContext.Provider value={{ role } as Me}>
      <Router hook={location.hook}>
        <Keys />
        {room}
      </Router>
    </MeContext.Provider>,
  );
}

function press(...keys: readonly (string | KeyboardEventInit)[]): void {
  for (const key of keys) fireEvent.keyDown(document.body, typeof key === "string" ? { key } : key);
}

beforeEach(() => {
  location = memoryLocation({ path: AT_WORK, record: true });
  ownKey.mockClear();
  window.addEventListener("keydown", ownKey);
});
afterEach(() => {
  window.removeEventListener("keydown", ownKey);
  cleanup();
});

it("go to the room of the letter, which the room one leaves does not hear", () => {
  atWork();
  press("g", "t");
  expect(location.history).toEqual([AT_WORK, "/c/3/table"]);
  expect(ownKey).toHaveBeenCalledOnce(); // of G
});

it("leave the room one is in as it is", () => {
  atWork();
  press("g", "w");
  expect(location.history).toEqual([AT_WORK]);
  expect(ownKey).toHaveBeenCalledOnce();
});

it.each([
  ["letters with Shift", ["g", { key: "T", shiftKey: true }]],
  ["letters after Shift", ["g", { key: "Shift", shiftKey: true }, "t"]],
  ["G with Shift", [{ key: "G", shiftKey: true }, "t"]],
  ["letters that do not follow G", ["g", "x", "t"]],
])("are not %s", (_, keys) => {
  atWork();
  press(...keys);
  expect(location.history).toEqual([AT_WORK]);
  expect(ownKey).toHaveBeenCalledTimes(keys.length);
});

it("are none of those that a person may not enter", () => {
  atWork(null, "annotator");
  press("g", "s");
  expect(location.history).toEqual([AT_WORK]);
});

it("rest while a dialog is open", () => {
  atWork(<dialog open>Skip this shape?</dialog>);
  press("g", "t");
  expect(location.history).toEqual([AT_WORK]);
});

it("rest while a menu is open", () => {
  atWork(<Menu label="Views">{null}</Menu>);
  const opened = Object.assign(new Event("toggle"), { newState: "open" });
  fireEvent(screen.getByRole("menu", { hidden: true }), opened);
  press("g", "t");
  expect(location.history).toEqual([AT_WORK]);
});
