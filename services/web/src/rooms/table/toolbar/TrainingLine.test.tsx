// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { cleanup, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { MeContext } from "../../../app/session/MeContext";
import type { Me } from "../../../app/session/session";
import { ToastProvider } from "../../../components";
import { TrainingLine } from "./TrainingLine";

const get = vi.hoisted(() => vi.fn());
const post = vi.hoisted(() => vi.fn());
vi.mock("../../../api/client", () => ({
  api: { GET: get, POST: post },
  body: (answer: unknown) => answer,
}));

const JOB = {
  id: 4,
  kind: "train",
  progress: { done: 0, failed: 0, total: null, message: "" },
  created_at: new Date().toISOString(),
  finished_at: "2026-01-02T00:00:00Z",
  message: "2 shapes are confirmed, 4 are needed",
};

/** The line for somebody, with jobs by their states, and the workers that operators are told of. */
function shown(role: Me["role"], jobs: Record<string, object[]>, workers: object[] = []) {
  get.mockImplementation(async (path: string, { params }: { params: { query?: { state: string } } }) => {
    if (path.endsWith("/ops")) return { workers };
    if (path.endsWith("/models")) return { items: [] };
    return { items: jobs[params.query?.state ?? ""] ?? [] };
  });
  render(
    <QueryClientProvider client={new QueryClient()}>
      <ToastProvider>
        <MeContext value={{ person_id: 1, name: "ann", role } as Me}>
          <TrainingLine collectionId={1} />
        </MeContext>
      </ToastProvider>
    </QueryClientProvider>,
  );
}

beforeEach(() => {
  get.mockReset();
  post.mockReset();
  post.mockResolvedValue({});
});
afterEach(cleanup);

it("says to whom may train why a training failed, and tries again", async () => {
  shown("reviewer", { failed: [{ ...JOB, state: "failed" }] });
  await screen.findByText("Model 1 could not be trained: 2 shapes are confirmed, 4 are needed");
  fireEvent.click(screen.getByRole("button", { name: "Try again" }));
  await waitFor(() => expect(post).toHaveBeenCalledOnce());
});

it("tells an operator that nobody is there to train", async () => {
  shown("operator", { pending: [{ ...JOB, state: "pending" }] });
  expect((await screen.findByText(/no worker is running/)).textContent).toBe(": no worker is running");
});

it("tells a reviewer since when a training waits, and asks nothing that they may not know", async () => {
  shown("reviewer", { pending: [{ ...JOB, state: "pending" }] });
  const line = await screen.findByText(/Model 1 waits to be trained/);
  expect(line.textContent).toContain(", asked for ");
  expect(get.mock.calls.some(([path]) => String(path).endsWith("/ops"))).toBe(false);
});
