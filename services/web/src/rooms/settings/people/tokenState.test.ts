import { describe, expect, it } from "vitest";
import { tokenState } from "./tokenState";

const AT = Date.parse("2026-06-01T00:00:00Z");

describe("a token", () => {
  it("is good until it ends", () =>
    expect(tokenState({ revoked_at: null, expires_at: "2026-06-02T00:00:00Z" }, AT)).toBe("good"));
  it("ends when its time is up", () =>
    expect(tokenState({ revoked_at: null, expires_at: "2026-06-01T00:00:00Z" }, AT)).toBe("expired"));
  it("ends for good when it is revoked", () =>
    expect(tokenState({ revoked_at: "2026-05-01T00:00:00Z", expires_at: "2026-05-15T00:00:00Z" }, AT)).toBe(
      "revoked",
    ));
});
