// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { cleanup, configure, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Problem } from "../../api/problem";
import { newQueryClient } from "../../api/queries";
import { CollectionContext } from "../../app/CollectionContext";
import { ToastProvider } from "../../components";
import { OperationsRoom } from "./OperationsRoom";

const AT = "2026-11-22T12:00:00Z";
const OPS = {
  measured_at: AT,
  states: { ready: 12, confirmed: 3 },
  stages: [{ stage: "mesh", done: 14, failed: 1, remaining: 0, per_min: 2.5, eta_s: null }],
  window_min: 15,
  failures: { error: 1, memory: 0 },
  queue: { free: 9, held: 1, assigned: 0, oldest_at: AT },
  leases: { held: 1, prefetched: 0, expired: 0, people: 1 },
  model_version: 2,
  score_name: "entropy",
  freshness: [{ model_version: 2, shapes: 12, share: 1 }],
  open_reviews: 0,
  blocks: [],
  disk: { database_bytes: 1000, array_bytes: 2000, free_bytes: 1e12 },
  workers: [],
};
const FAILURE = {
  shape_id: 5,
  source_key: "broken.off",
  stage: "mesh",
  kind: "error",
  message: "broken.off: an ASCII OFF file must start with OFF",
  attempts: 1,
  at: AT,
};
const EMPTY = { items: [], next: null };

const { service } = vi.hoisted(() => ({
  service: { answers: {} as Record<string, (init: unknown) => unknown> },
}));

vi.mock("../../api/client", () => {
  const ask = async (path: string, init: unknown) => ({ data: service.answers[path]?.(init) });
  return {
    api: { GET: ask, POST: ask },
    body: async (call: Promise<{ data: unknown }>) => (await call).data,
  };
});
vi.mock("./charts/useLineChart", () => ({ useLineChart: () => false })); // jsdom draws nothing

const IN = "/api/v1/collections/{collection_id}";

beforeEach(() => {
  service.answers = {
    [`${IN}/ops`]: () => OPS,
    [`${IN}/jobs`]: () => EMPTY,
    [`${IN}/failures`]: () => ({ items: [FAILURE], next: null }),
    [`${IN}/leases`]: () => EMPTY,
    [`${IN}/skips`]: () => EMPTY,
    [`${IN}/rounds`]: () => ({ score_name: "entropy", items: [] }),
    "/api/v1/ops/people": () => ({ days: 30, items: [] }),
    "/api/v1/people": () => EMPTY,
  };
});
// A busy machine needs seconds for a whole room.
configure({ asyncUtilTimeout: 20_000 });
vi.setConfig({ testTimeout: 60_000 });

afterEach(cleanup);

function show(): void {
  const collection = { id: 3, name: "chairs", settings: {}, schema_version: 1, created_at: AT };
  render(
    <QueryClientProvider client={newQueryClient()}>
      <ToastProvider>
        <CollectionContext value={collection}>
          <OperationsRoom collectionId={3} />
        </CollectionContext>
      </ToastProvider>
    </QueryClientProvider>,
  );
}

it("names a shape that failed, with its reason, and what kind of failure it is", async () => {
  show();
  const row = (await screen.findByText("broken.off")).closest("tr");
  expect(row?.textContent).toContain("Refused: an ASCII OFF file must start with OFF");
});

it("tries what was chosen again", async () => {
  const asked = vi.fn(() => ({ n_retried: 1, job: null }));
  service.answers[`${IN}/failures/retry`] = asked;
  show();
  fireEvent.click(await screen.findByLabelText("Choose broken.off"));
  fireEvent.click(screen.getByRole("button", { name: "Try 1 again" }));
  await waitFor(() => expect(asked).toHaveBeenCalledOnce());
  expect(asked).toHaveBeenCalledWith(expect.objectContaining({ body: { text: "", shape_ids: [5] } }));
  expect(await screen.findByText("1 shape will be tried again as soon as a worker is free.")).toBeDefined();
});

it("names the tab and shows key figures", async () => {
  show();
  expect((await screen.findByText("of 15 shapes, 20%")).textContent).toBe("of 15 shapes, 20%");
  expect(document.title).toBe("Operations · chairs · Partwise");
});

it("tells what workers take, at a job or not", async () => {
  const idle = { owner: "node-1:7:a", is_busy: false, job_id: null, job_kind: null, silent_s: 3, done: null };
  const usage = { memory_bytes: 4e8, n_actors: 2, actor_bytes: 3.1e9, free_bytes: null };
  const silent = { ...idle, owner: "node-2:7:b", is_busy: true, silent_s: 90, usage: null };
  service.answers[`${IN}/ops`] = () => ({
    ...OPS,
    workers: [
      { ...idle, total: null, usage },
      { ...silent, total: 12, job_id: 4, job_kind: "evaluate", done: 5 },
    ],
  });
  show();
  const row = async (name: string) => (await screen.findByText(name)).closest("tr")?.textContent;
  expect(await row("node-1:7:a")).toBe("node-1:7:aWaits for a job–400 MB3.1 GB in 2 processes–3 s ago");
  expect(await row("node-2:7:b")).toBe("node-2:7:bScore shapes5 of 12–––silent for 1 min");
});

it("says what to do where figures cannot be read, and keeps the lists", async () => {
  service.answers[`${IN}/ops`] = () => {
    throw new Problem({
      type: "urn:partwise:problem:conflict",
      title: "",
      status: 409,
      detail: "Busy; try again.",
    });
  };
  show();
  expect((await screen.findByRole("alert")).textContent).toContain("Busy; try again.");
  expect(await screen.findByText("broken.off")).toBeDefined();
  expect(screen.queryByRole("heading", { name: "Stages" })).toBeNull();
});

it("says why shapes were skipped, and by whom", async () => {
  const skip = {
    shape_id: 7,
    source_key: "two.off",
    person_id: 4,
    person_name: "ann",
    reason: "two in one",
    skipped_at: AT,
  };
  service.answers[`${IN}/skips`] = () => ({ items: [skip], next: null });
  show();
  const row = (await screen.findByText("two in one")).closest("tr");
  expect(row?.textContent).toContain("ann");
  expect(screen.getByRole("link", { name: "two.off" }).getAttribute("href")).toContain("7");
});
