import { describe, expect, it } from "vitest";
import { aRow } from "../rows/testing";
import { initials, scoreText, tileWords } from "./stateWords";

describe("scoreText", () => {
  it.each([
    [0, "0.000"],
    [0.31249, "0.312"],
    [1.5, "1.500"],
    [0.0836, "0.084"],
    [1234.5, "1235"],
    [0.00004, "4e-5"],
  ])("%f as %s", (score, text) => expect(scoreText(score)).toBe(text));
});

describe("initials", () => {
  it.each([
    ["ann", "A"],
    ["Ann Maria Novak", "AN"],
    ["ann.novak", "AN"],
    ["", ""],
  ])("%s", (name, letters) => expect(initials(name)).toBe(letters));
});

describe("tileWords", () => {
  const holder = { person_id: 2, name: "bo", expires_at: "2026-01-01T12:00:00Z" };
  const row = aRow({
    state: "confirmed",
    author_name: "ann",
    score: 0.25,
    model_version: 3,
    held_by: [holder],
  });

  it("says everything that the tile shows", () => {
    const words = tileWords(row, "Entropy", Date.parse("2026-01-01T11:59:00Z"));
    expect(words).toBe("chairs/a.off, Confirmed, by ann, Entropy 0.250, model 3, bo is working on it");
  });

  it("leaves out who held it once the time is over", () => {
    expect(tileWords(row, null, Date.parse("2026-01-01T12:01:00Z"))).not.toContain("bo");
  });

  it("says what failed", () => {
    expect(tileWords(aRow({ state: "failed", failed_stage: "remesh" }), null, 0)).toContain(
      "remeshing failed",
    );
  });
});
