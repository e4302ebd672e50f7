import { describe, expect, it } from "vitest";
import type { AcceptBatch, Review } from "./reviewRequests";
import { detailWords, effortWords, falseAcceptWords } from "./reviewWords";

const review = (detail: Review["detail"]): Review => ({
  id: 1,
  collection_id: 1,
  shape_id: 1,
  revision_id: 1,
  reason: "check",
  detail,
  created_at: "2026-01-01T00:00:00Z",
  resolved_at: null,
  resolved_by: null,
  outcome: null,
  effort: null,
});

const batch = (given: Partial<AcceptBatch>): AcceptBatch => ({
  id: 1,
  person_id: 1,
  person_name: "lea",
  segmentation: "refined",
  agreement: 0.9,
  accepted_at: "2026-01-01T00:00:00Z",
  n_accepted: 40,
  n_rechecks: 9,
  n_rechecked: 9,
  n_false: 2,
  false_accept_rate: 2 / 9,
  interval: [0.063, 0.547],
  ...given,
});

describe("detailWords", () => {
  it("is the note, or how much agrees, or nothing", () => {
    expect(detailWords(review({ note: "the wing" }))).toBe("“the wing”");
    expect(detailWords(review({ agreement: 0.805 }))).toBe("80.5% of the area agrees.");
    expect(detailWords(review({}))).toBeNull();
  });
});

describe("effortWords", () => {
  it("is time and clicks, or nothing where nobody noted them", () => {
    expect(effortWords({ active_s: 130, n_clicks: 1 })).toBe("2 min 10 s of work, 1 click");
    expect(effortWords({ active_s: 0, n_clicks: 0 })).toBe("under 1 s of work, 0 clicks");
    expect(effortWords({ active_s: 180.5, n_clicks: 2 })).toBe("3 min of work, 2 clicks");
    expect(effortWords(null)).toBeNull();
  });
});

describe("falseAcceptWords", () => {
  it("is the rate with its interval", () => {
    expect(falseAcceptWords(batch({}))).toBe("22.2% wrong (95% interval 6.3% to 54.7%): 2 of 9 checked.");
  });

  it("says how many still wait", () => {
    expect(falseAcceptWords(batch({ n_rechecked: 4 }))).toContain("So far; 5 still wait.");
  });

  it("says that nobody knows yet, or that nobody asked", () => {
    const none = { n_rechecked: 0, n_false: 0, false_accept_rate: null, interval: null };
    expect(falseAcceptWords(batch({ ...none, n_rechecks: 1 }))).toBe(
      "Not known yet: 1 shape waits for a blind check.",
    );
    expect(falseAcceptWords(batch({ ...none, n_rechecks: 0 }))).toBe("No blind check was asked for.");
  });
});
