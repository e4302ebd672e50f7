import { describe, expect, it } from "vitest";
import type { Collection } from "../../../app/CollectionContext";
import { changesBetween, DEFAULTS, settingsOf } from "./defaults";
import { isWholeIn } from "./NumberSetting";

const collection = (settings: Collection["settings"]): Collection => ({
  id: 1,
  name: "chairs",
  settings,
  schema_version: 1,
  created_at: "2026-01-01T00:00:00Z",
});

describe("a collection's settings", () => {
  it("are the usual ones where nothing was set", () => expect(settingsOf(collection({}))).toEqual(DEFAULTS));
  it("are what was set", () => expect(settingsOf(collection({ train_after: 20 })).train_after).toBe(20));
  it("pass over what is of another kind", () =>
    expect(settingsOf(collection({ review: "yes" })).review).toBe(false));
  it("differ in what was changed", () =>
    expect(changesBetween(DEFAULTS, { ...DEFAULTS, review: true })).toEqual({ review: true }));
});

describe("a whole number in a range", () => {
  it.each(["1", "9", " 5 "])("may be %j", (text) => expect(isWholeIn(text, 1, 9)).toBe(true));
  it.each(["", "0", "10", "1.5", "-1", "1e0", "x"])("may not be %j", (text) =>
    expect(isWholeIn(text, 1, 9)).toBe(false),
  );
});
