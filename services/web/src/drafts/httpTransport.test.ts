import { afterEach, expect, it, vi } from "vitest";
import { api } from "../api/client";
import { Unreachable } from "../api/problem";
import { confirmDraft } from "./confirming";
import { httpTransport } from "./httpTransport";
import type { StrokeSender } from "./strokeSender";

const SAVED = { flush: async () => true, strokes: [], draft: { draftId: 7 } } as unknown as StrokeSender;

afterEach(() => vi.restoreAllMocks());

it("gives up a confirmation that is never answered, so that the person may confirm again", async () => {
  const patience = new AbortController();
  vi.spyOn(AbortSignal, "timeout").mockReturnValue(patience.signal);
  vi.spyOn(api, "POST").mockImplementation(
    ((_path: string, { signal }: RequestInit) =>
      new Promise((_, reject) => {
        signal?.addEventListener("abort", () => reject(new Unreachable(signal.reason)));
      })) as never,
  );
  const confirming = confirmDraft(httpTransport, SAVED, "abc");
  await vi.waitFor(() => expect(api.POST).toHaveBeenCalled());
  patience.abort();
  expect(await confirming).toMatchObject({ kind: "unreachable" });
});
