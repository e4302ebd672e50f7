import { describe, expect, it, vi } from "vitest";
import { SHORTCUTS, shortcutOf, type WorkbenchActions } from "./shortcuts";

function pressed(key: string, more: Partial<KeyboardEvent> & { isAltGraph?: boolean } = {}) {
  const { isAltGraph = false, ...event } = more;
  return {
    key,
    code: "",
    ctrlKey: false,
    metaKey: false,
    shiftKey: false,
    altKey: false,
    getModifierState: (name: string) => name === "AltGraph" && isAltGraph,
    ...event,
  };
}

function ran(event: ReturnType<typeof pressed>, action: keyof WorkbenchActions): unknown[] | undefined {
  const act = vi.fn();
  const found = shortcutOf(event);
  found?.shortcut.run({ [action]: act } as unknown as WorkbenchActions, found.key);
  return act.mock.calls[0];
}

describe("keys", () => {
  it("are each given once", () => {
    const keys = SHORTCUTS.flatMap((shortcut) => shortcut.keys);
    expect(new Set(keys).size).toBe(keys.length);
  });

  it("have a line of their own on the sheet", () => {
    expect(new Set(SHORTCUTS.map((shortcut) => shortcut.what)).size).toBe(SHORTCUTS.length);
  });

  it("of digits pick parts, also with Shift on any keyboard", () => {
    expect(ran(pressed("1", { code: "Digit1" }), "usePart")).toEqual([0]);
    expect(ran(pressed("0", { code: "Digit0" }), "usePart")).toEqual([9]);
    expect(ran(pressed("!", { code: "Digit1", shiftKey: true }), "usePart")).toEqual([10]);
    expect(ran(pressed("&", { code: "Digit1" }), "usePart")).toEqual([0]); // French: digits are behind Shift
    expect(ran(pressed("1", { code: "Digit1", shiftKey: true }), "usePart")).toEqual([10]);
  });

  it.each([
    ["German, on Linux", pressed("[", { code: "Digit8", isAltGraph: true })],
    ["German, on Windows", pressed("[", { code: "Digit8", isAltGraph: true, ctrlKey: true, altKey: true })],
    ["German, on a Mac", pressed("[", { code: "Digit5", altKey: true })],
    ["American", pressed("[", { code: "BracketLeft" })],
    ["German, where Americans have it", pressed("ü", { code: "BracketLeft" })],
  ])("make the brush smaller by [: %s", (_, event) => {
    expect(ran(event, "scaleBrush")).toEqual([-1]);
  });

  it("make the brush larger by the key that Americans have for it, unless that brings a view nearer", () => {
    expect(ran(pressed("¨", { code: "BracketRight" }), "scaleBrush")).toEqual([1]);
    expect(shortcutOf(pressed("+", { code: "BracketRight" }))).toBeNull();
  });

  it("undo and redo with Ctrl or Command", () => {
    expect(ran(pressed("z", { metaKey: true }), "undo")).toEqual([]);
    expect(ran(pressed("Z", { ctrlKey: true, shiftKey: true }), "redo")).toEqual([]);
    expect(ran(pressed("y", { ctrlKey: true }), "redo")).toEqual([]);
  });

  it("that mean nothing here are left to the browser", () => {
    expect(shortcutOf(pressed("r", { ctrlKey: true }))).toBeNull();
    expect(shortcutOf(pressed("b", { altKey: true }))).toBeNull();
    expect(shortcutOf(pressed("1", { code: "Digit1", altKey: true }))).toBeNull();
    expect(shortcutOf(pressed("{", { code: "Digit7", isAltGraph: true }))).toBeNull();
  });

  it("leave G to rooms, whose keys it leads", () => {
    expect(shortcutOf(pressed("g"))).toBeNull();
  });

  it("show the sheet by ?, whose keyboard places it differently", () => {
    expect(ran(pressed("?", { shiftKey: true }), "showKeys")).toEqual([]);
    expect(ran(pressed("?"), "showKeys")).toEqual([]);
  });
});
