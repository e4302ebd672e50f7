import { expect, it } from "vitest";
import { wordsOf } from "./SaveMark";

const queued = { nQueued: 1, isKept: true, why: "" };

it.each([
  [{ kind: "saved" }, "Saved"],
  [{ kind: "saving", ...queued }, "Saving…"],
  [{ kind: "offline", ...queued }, "Offline: 1 queued"],
  [{ kind: "offline", ...queued, nQueued: 12 }, "Offline: 12 queued"],
  [{ kind: "signed-out", ...queued }, "Log in to send 1 stroke"],
  [{ kind: "closed", ...queued }, "1 stroke not taken"],
  [{ kind: "refused", ...queued, nQueued: 2 }, "2 strokes refused"],
] as const)("says of %o: %s", (state, words) => {
  expect(wordsOf(state)).toBe(words);
});
