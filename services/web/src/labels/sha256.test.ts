import { createHash } from "node:crypto";
import { describe, expect, it } from "vitest";
import { labelsSha256, sha256 } from "./sha256";

describe("SHA-256", () => {
  it.each([0, 1, 55, 56, 63, 64, 65, 119, 120, 1000])("of %i bytes", (length) => {
    const bytes = Uint8Array.from({ length }, (_, place) => (place * 37) & 255);
    expect(sha256(bytes)).toBe(createHash("sha256").update(bytes).digest("hex"));
  });

  it("of labels is that of their bytes, low first", () => {
    expect(labelsSha256(Uint16Array.of(0x0102, 3))).toBe(sha256(Uint8Array.of(2, 1, 3, 0)));
  });
});
