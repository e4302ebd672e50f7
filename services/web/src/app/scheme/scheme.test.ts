// @vitest-environment jsdom
import { beforeEach, describe, expect, it } from "vitest";
import { applyScheme, savedScheme, saveScheme } from "./scheme";

beforeEach(() => localStorage.clear());

describe("the scheme", () => {
  it("is the system's until one is chosen", () => expect(savedScheme(localStorage)).toBe("system"));

  it("is kept", () => {
    saveScheme("dark", localStorage);
    expect(savedScheme(localStorage)).toBe("dark");
  });

  it("is the system's if what was kept makes no sense", () => {
    localStorage.setItem("partwise.scheme", "purple");
    expect(savedScheme(localStorage)).toBe("system");
  });

  it("is on the document, and leaves it again", () => {
    const root = document.createElement("html");
    applyScheme("dark", root);
    expect(root.dataset.scheme).toBe("dark");
    applyScheme("system", root);
    expect(root.dataset.scheme).toBeUndefined();
  });
});
