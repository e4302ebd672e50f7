// @vitest-environment jsdom
import { act, cleanup, fireEvent, render, screen } from "@testing-library/react";
import { type ReactNode, useLayoutEffect, useRef } from "react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Observable } from "../../../drafts/observable";
import type { ShapeStage } from "../../../viewer/shapeStage";
import type { Desk } from "../desk/desk";
import type { HeldShape } from "../desk/heldShape";
import { ToolShelf } from "../tools/toolSettings";
import { Stage } from "./Stage";
import type { LiveView, ViewportProps } from "./Viewport";
import { ONE_VIEW, type Views } from "./views";

vi.mock("./StageArea", () => ({
  StageArea: ({ children }: { children: (stage: ShapeStage) => ReactNode }) =>
    children({ link: () => undefined } as unknown as ShapeStage),
}));
vi.mock("./Viewport", () => ({ Viewport: FakeViewport }));

/** A view that is only its name, and whether it is marked. */
function FakeViewport({ place, held, isActive, context, onView }: ViewportProps) {
  const element = useRef<HTMLButtonElement>(null);
  const latest = useRef(onView);
  latest.current = onView;
  useLayoutEffect(() => {
    latest.current({ place, view: { element: element.current } } as unknown as LiveView);
    return () => latest.current(null);
  }, [place]);
  return (
    <button ref={element} type="button" aria-pressed={isActive} onFocus={() => context.onEngage()}>
      {`${place}: shape ${held.shapeId}`}
    </button>
  );
}

const fakeShape = (shapeId: number) => ({ shapeId, lease: { source_key: "" } }) as unknown as HeldShape;
const [first, second, third] = [fakeShape(1), fakeShape(2), fakeShape(3)];
const shelf = new ToolShelf({ getItem: () => null, setItem: () => undefined });
let state: Observable<{ shapes: readonly HeldShape[]; current: HeldShape }>;
/** The place of the view that keys act on. */
let acting: number | null;

function stageOf(some: Partial<Views>) {
  const desk = {
    state,
    begin: () => undefined,
    show: (current: HeldShape) => state.set({ ...state.get(), current }),
  } as unknown as Desk;
  return (
    <Stage
      {...{ desk, shelf }}
      parts={[]}
      patches={{ map: null, isCutting: false, why: null }}
      views={{ ...ONE_VIEW, ...some }}
      up="y"
      scheme="light"
      onActive={(live) => {
        acting = live?.place ?? null;
      }}
      onUnseen={() => undefined}
      onViews={() => undefined}
      onRetry={() => undefined}
    />
  );
}

const marked = () =>
  screen.getAllByRole("button", { pressed: true }).map((view) => Number(view.textContent?.[0]));
const show = (current: HeldShape) => act(() => state.set({ ...state.get(), current }));

beforeEach(() => {
  state = new Observable({ shapes: [first, second, third], current: first });
});
afterEach(cleanup);

it("marks the view that a person works in, at once, and keys act on that", () => {
  render(stageOf({ count: 4 }));
  expect([marked(), acting]).toEqual([[0], 0]);
  fireEvent.focus(screen.getByText(/^3:/));
  expect([marked(), acting]).toEqual([[3], 3]);
});

it("has keys act on a view that is still there once there are fewer", () => {
  const { rerender, unmount } = render(stageOf({ count: 4 }));
  fireEvent.focus(screen.getByText(/^3:/));
  rerender(stageOf({ count: 1 }));
  expect([marked(), acting]).toEqual([[0], 0]);
  unmount();
  expect(acting).toBeNull();
});

it("follows the shape in hand, where each view has one of its own", () => {
  render(stageOf({ count: 3, content: "shapes" }));
  act(() => screen.getByText("0: shape 1").focus());
  show(second);
  expect([marked(), acting]).toEqual([[1], 1]);
  expect(document.activeElement).toBe(screen.getByText("1: shape 2")); // whose keys turn what is marked
  fireEvent.focus(screen.getByText("2: shape 3"));
  expect([state.get().current, marked(), acting]).toEqual([third, [2], 2]);
});

it("shows the shape in hand, though there are more shapes than views", () => {
  render(stageOf({ count: 2, content: "shapes" }));
  show(third);
  expect(screen.getAllByRole("button").map((view) => view.textContent)).toEqual(["0: shape 1", "1: shape 3"]);
  expect([marked(), acting]).toEqual([[1], 1]);
});
