// @vitest-environment jsdom
import { cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, describe, expect, it, vi } from "vitest";
import { Button } from "./Button";
import { DataTable } from "./DataTable";
import { IconButton } from "./IconButton";
import { Input } from "./Input";
import { Progress } from "./Progress";
import { Segmented } from "./Segmented";
import { Select } from "./Select";
import { Slider } from "./Slider";
import { TextArea } from "./TextArea";
import { ToastProvider, useToast } from "./Toasts";

afterEach(cleanup);

const TWO = [
  { value: "a", label: "First" },
  { value: "b", label: "Second" },
] as const;

describe("controls", () => {
  it("a busy button takes no clicks and keeps its place in the order of focus", () => {
    const onClick = vi.fn();
    render(
      <Button isBusy onClick={onClick}>
        Save
      </Button>,
    );
    const button = screen.getByRole("button", { name: "Save" });
    fireEvent.click(button);
    expect(onClick).not.toHaveBeenCalled();
    expect(button).toHaveProperty("disabled", false);
    expect(button.getAttribute("aria-disabled")).toBe("true");
  });

  it("an icon button has a name, and says whether it is down", () => {
    render(<IconButton label="Grid" icon={<svg />} isPressed shortcut="Ctrl+G" />);
    const button = screen.getByRole("button", { name: "Grid", pressed: true });
    expect(button.getAttribute("aria-keyshortcuts")).toBe("Control+G");
  });

  it.each([Input, TextArea])("an error is tied to its field and announced", (Control) => {
    render(<Control label="Name" error="Too long." />);
    const input = screen.getByLabelText("Name");
    expect(input.getAttribute("aria-invalid")).toBe("true");
    expect(input.getAttribute("aria-describedby")).toBe(screen.getByRole("alert").id);
  });

  it("a select tells the value that was chosen", () => {
    const onChange = vi.fn();
    render(<Select label="Order" options={TWO} value="a" onChange={onChange} />);
    fireEvent.change(screen.getByRole("combobox", { name: "Order" }), { target: { value: "b" } });
    expect(onChange).toHaveBeenCalledWith("b");
  });

  it("a segmented choice is a group of radio buttons", () => {
    const onChange = vi.fn();
    render(<Segmented label="View" options={TWO} value="a" onChange={onChange} />);
    expect(screen.getByRole("group", { name: "View" })).toBeDefined();
    fireEvent.click(screen.getByRole("radio", { name: "Second" }));
    expect(onChange).toHaveBeenCalledWith("b");
  });

  it("a slider says its value in words and commits when it is let go", () => {
    const onCommit = vi.fn();
    render(
      <Slider
        label="Radius"
        min={0}
        max={1}
        step={0.1}
        value={0.5}
        format={(v) => `${v * 100}%`}
        onChange={() => undefined}
        onCommit={onCommit}
      />,
    );
    const slider = screen.getByRole("slider", { name: "Radius" });
    expect(slider.getAttribute("aria-valuetext")).toBe("50%");
    fireEvent.pointerUp(slider);
    expect(onCommit).toHaveBeenCalledWith(0.5);
  });

  it("progress that nobody knows has no value", () => {
    render(<Progress label="Training" />);
    expect(screen.getByRole("progressbar", { name: "Training" }).getAttribute("aria-valuenow")).toBeNull();
  });

  it("a table without rows says so", () => {
    const columns = [{ id: "n", header: "Name", cell: () => "" }];
    render(<DataTable caption="Jobs" columns={columns} rows={[]} keyOf={() => 0} empty="No jobs." />);
    expect(screen.getByRole("table", { name: "Jobs" }).textContent).toContain("No jobs.");
  });
});

function Trigger({ tone }: { tone: "good" | "bad" }) {
  const toast = useToast();
  return (
    <button type="button" onClick={() => toast({ message: "Told.", tone })}>
      Tell
    </button>
  );
}

describe("toasts", () => {
  it.each([
    ["good", "status"],
    ["bad", "alert"],
  ] as const)("%s news go to the %s region", (tone, role) => {
    render(
      <ToastProvider>
        <Trigger tone={tone} />
      </ToastProvider>,
    );
    fireEvent.click(screen.getByRole("button", { name: "Tell" }));
    expect(screen.getByRole(role).textContent).toContain("Told.");
  });

  it("say the same only once, and can be dismissed", () => {
    render(
      <ToastProvider>
        <Trigger tone="bad" />
      </ToastProvider>,
    );
    fireEvent.click(screen.getByRole("button", { name: "Tell" }));
    fireEvent.click(screen.getByRole("button", { name: "Tell" }));
    fireEvent.click(screen.getByRole("button", { name: "Dismiss" }));
    expect(screen.queryByText("Told.")).toBeNull();
  });
});
