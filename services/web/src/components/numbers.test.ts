import { describe, expect, it } from "vitest";
import { bytes, count, decimal, percent, short, whole } from "./numbers";

describe("numbers as people read them", () => {
  it("groups thousands", () => expect(whole(300_000)).toBe("300,000"));
  it("has one digit after the point below 100", () => expect(decimal(12.34)).toBe("12.3"));
  it("has none from 100 on", () => expect(decimal(123.4)).toBe("123"));
  it("shortens large ones", () => expect(short(12_345)).toBe("12.3K"));
  it("says one shape", () => expect(count(1, "shape")).toBe("1 shape"));
  it("says no shapes", () => expect(count(0, "shape")).toBe("0 shapes"));
  it("knows odd plurals", () => expect(count(2, "try", "tries")).toBe("2 tries"));
  it("says shares as percentages", () => expect(percent(0.9364)).toBe("93.6%"));
  it.each([
    [0, "0 B"],
    [999, "999 B"],
    [12_300_000, "12.3 MB"],
    [2e18, "2,000 PB"],
  ])("%d bytes are %s", (n, words) => expect(bytes(n)).toBe(words));
});
