// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { cleanup, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { afterEach, beforeAll, beforeEach, describe, expect, it, vi } from "vitest";
import { api } from "../api/client";
import { ToastProvider } from "../components";
import { AcceptChanged } from "./AcceptChanged";

const counted = vi.spyOn(api, "GET");
const accepted = vi.spyOn(api, "POST");

beforeAll(() => {
  // jsdom has no modal dialogs yet
  HTMLDialogElement.prototype.showModal ??= function (this: HTMLDialogElement) {
    this.open = true;
  };
  HTMLDialogElement.prototype.close ??= function (this: HTMLDialogElement) {
    this.open = false;
  };
});
beforeEach(() => {
  counted.mockReset();
  accepted.mockReset();
});
afterEach(cleanup);

function shown(nWaiting: number) {
  counted.mockResolvedValue({ data: { n_reviews: nWaiting } } as never);
  const client = new QueryClient({ defaultOptions: { queries: { retry: false } } });
  render(
    <QueryClientProvider client={client}>
      <ToastProvider>
        <AcceptChanged collectionId={7} />
      </ToastProvider>
    </QueryClientProvider>,
  );
  return client;
}

describe("AcceptChanged", () => {
  it("accepts all that wait since parts have changed, once that was asked", async () => {
    shown(2000);
    fireEvent.click(await screen.findByText(/Accept all 2,000/));
    expect(accepted).not.toHaveBeenCalled();
    counted.mockResolvedValue({ data: { n_reviews: 0 } } as never);
    accepted.mockResolvedValue({ data: { n_accepted: 2000 } } as never);
    fireEvent.click(screen.getByText("Accept all"));
    await waitFor(() => expect(screen.queryByRole("alertdialog", { hidden: true })).toBeNull());
    expect(accepted).toHaveBeenCalledWith("/api/v1/collections/{collection_id}/reviews/accept", {
      params: { path: { collection_id: 7 } },
      body: { reason: "schema" },
    });
    await waitFor(() => expect(screen.queryByText(/whose parts have changed/)).toBeNull());
    expect(screen.getByText("Labels of 2,000 shapes accepted")).toBeTruthy();
  });

  it("is not there for a single one, which has a button of its own", async () => {
    const client = shown(1);
    await waitFor(() => expect(client.getQueryData(["reviews", 7, "count", "schema"])).toBe(1));
    expect(screen.queryByRole("button")).toBeNull();
  });
});
