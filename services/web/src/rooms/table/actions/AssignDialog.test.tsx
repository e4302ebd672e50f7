// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { cleanup, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { ToastProvider } from "../../../components";
import { peopleQuery } from "../rows/tableQueries";
import { aRow } from "../rows/testing";
import { AssignDialog } from "./AssignDialog";
import { assign } from "./actionRequests";

vi.mock("./actionRequests", () => ({ assign: vi.fn() }));
const asked = vi.mocked(assign);

beforeEach(() => {
  // jsdom has dialogs, but does not open them.
  HTMLDialogElement.prototype.showModal = function () {
    this.open = true;
  };
  HTMLDialogElement.prototype.close = function () {
    this.open = false;
  };
  asked.mockReset();
  asked.mockResolvedValue({ n_places: 1 });
  const client = new QueryClient({ defaultOptions: { queries: { staleTime: Number.POSITIVE_INFINITY } } });
  client.setQueryData(peopleQuery.queryKey, { items: [{ id: 7, name: "ann", created_at: "" }] });
  render(
    <QueryClientProvider client={client}>
      <ToastProvider>
        <AssignDialog
          collectionId={1}
          rows={new Map([[3, aRow({ id: 3 })]])}
          teller={{ tell: () => undefined, dialog: null }}
          onActed={() => undefined}
          onClose={() => undefined}
        />
      </ToastProvider>
    </QueryClientProvider>,
  );
});
afterEach(cleanup);

const choose = (person: string) =>
  fireEvent.change(screen.getByLabelText("To"), { target: { value: person } });
const button = (name: string) => screen.getByRole<HTMLButtonElement>("button", { name });

it("waits for somebody to be chosen", () => {
  expect(button("Assign").disabled).toBe(true);
});

it("assigns to the one who was chosen, and offers no undoing of what it cannot undo", async () => {
  choose("7");
  fireEvent.click(button("Assign"));
  await screen.findByText("1 waiting label is assigned");
  expect(asked).toHaveBeenCalledWith(1, [3], 7);
  expect(screen.queryByRole("button", { name: "Undo" })).toBeNull();
});

it("says so where anybody is to have them", async () => {
  choose("");
  fireEvent.click(button("Let anybody have them"));
  await waitFor(() => expect(asked).toHaveBeenCalledWith(1, [3], null));
});
