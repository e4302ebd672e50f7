import { onlineManager } from "@tanstack/react-query";
import { afterEach, describe, expect, it } from "vitest";
import { newQueryClient } from "./queries";

afterEach(() => onlineManager.setOnline(true));

describe("a browser that believes it has no network", () => {
  it("asks the service all the same, which may be on its own machine", async () => {
    onlineManager.setOnline(false);
    const answer = await newQueryClient().fetchQuery({ queryKey: ["jobs"], queryFn: async () => "answer" });
    expect(answer).toBe("answer");
  });

  it("says at once that something could not be done, rather than wait", async () => {
    onlineManager.setOnline(false);
    const client = newQueryClient();
    const mutation = client.getMutationCache().build(
      client,
      client.defaultMutationOptions({
        mutationFn: async () => {
          throw new Error("The service cannot be reached.");
        },
      }),
    );
    await expect(mutation.execute(undefined)).rejects.toThrow("cannot be reached");
  });
});
