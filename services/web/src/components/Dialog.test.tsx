// @vitest-environment jsdom
import { cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeAll, describe, expect, it, vi } from "vitest";
import { Dialog } from "./Dialog";
import { ToastProvider, useToast } from "./Toasts";

beforeAll(() => {
  // What jsdom's dialogs lack: being modal.
  HTMLDialogElement.prototype.showModal ??= function show(this: HTMLDialogElement) {
    this.open = true;
  };
  HTMLDialogElement.prototype.close ??= function close(this: HTMLDialogElement) {
    this.open = false;
  };
});
afterEach(cleanup);

describe("a dialog", () => {
  it("is called by its title", () => {
    render(<Dialog title="Take it away?">text</Dialog>);
    expect(screen.getByRole("dialog", { name: "Take it away?" })).toBeDefined();
  });

  it("begins at its first field, not at the cross", () => {
    render(
      <Dialog title="New" onClose={() => undefined}>
        <input aria-label="Name" />
      </Dialog>,
    );
    expect(document.activeElement).toBe(screen.getByLabelText("Name"));
  });

  it("is closed by Escape, which the browser tells as cancel", () => {
    const onClose = vi.fn();
    render(
      <Dialog title="New" onClose={onClose}>
        text
      </Dialog>,
    );
    fireEvent(screen.getByRole("dialog"), new Event("cancel", { cancelable: true }));
    expect(onClose).toHaveBeenCalledOnce();
  });

  it("stays until it is answered where it cannot be closed", () => {
    render(<Dialog title="Log in again">text</Dialog>);
    const cancel = new Event("cancel", { cancelable: true });
    fireEvent(screen.getByRole("dialog"), cancel);
    expect(cancel.defaultPrevented).toBe(true);
    expect(screen.queryByRole("button", { name: "Close" })).toBeNull();
  });

  it("keeps keys from the room below it", () => {
    const onKey = vi.fn();
    window.addEventListener("keydown", onKey);
    render(
      <Dialog title="New">
        <input aria-label="Name" />
      </Dialog>,
    );
    fireEvent.keyDown(screen.getByLabelText("Name"), { key: "x" });
    window.removeEventListener("keydown", onKey);
    expect(onKey).not.toHaveBeenCalled();
  });

  it("shows toasts within itself, as what is behind it cannot be reached", () => {
    const shown = (isOpen: boolean) => (
      <ToastProvider>
        <Teller />
        {isOpen && <Dialog title="New">text</Dialog>}
      </ToastProvider>
    );
    const { rerender } = render(shown(true));
    fireEvent.click(screen.getByRole("button", { name: "Tell" }));
    expect(screen.getByRole("dialog").contains(screen.getByText("Told."))).toBe(true);
    rerender(shown(false));
    expect(screen.getByText("Told.")).toBeDefined();
  });
});

function Teller() {
  const toast = useToast();
  return (
    <button type="button" onClick={() => toast({ message: "Told.", tone: "bad" })}>
      Tell
    </button>
  );
}
