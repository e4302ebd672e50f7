// @vitest-environment jsdom
import { act, cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { StageArea } from "./StageArea";

interface FakeStage {
  onContext: ((state: "lost" | "restored") => void) | null;
  readonly dispose: () => void;
}

const LOST = "The graphics card was taken away";
const stages = vi.hoisted((): FakeStage[] => []);

vi.mock("../../../viewer/shapeStage", () => ({
  ShapeStage: class implements FakeStage {
    onContext: FakeStage["onContext"] = null;
    readonly dispose = vi.fn();

    constructor() {
      stages.push(this);
    }
  },
}));

beforeEach(() => {
  stages.length = 0;
  render(
    <StageArea count={1} onUnseen={() => undefined}>
      {() => <p>views</p>}
    </StageArea>,
  );
  act(() => stages[0]?.onContext?.("lost"));
});
afterEach(cleanup);

it("says that the graphics card was taken away until it is back", () => {
  expect(screen.getByText(LOST)).toBeDefined();
  act(() => stages[0]?.onContext?.("restored"));
  expect(screen.queryByText(LOST)).toBeNull();
});

it("shows the shapes again on a stage of its own, which has lost nothing yet", () => {
  fireEvent.click(screen.getByRole("button", { name: "Show the shapes again" }));
  expect(stages[0]?.dispose).toHaveBeenCalledOnce();
  expect(stages).toHaveLength(2);
  expect(screen.queryByText(LOST)).toBeNull();
  expect(screen.getByText("views")).toBeDefined();
  act(() => stages[1]?.onContext?.("lost"));
  expect(screen.getByText(LOST)).toBeDefined();
});
