// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { cleanup, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { api } from "../api/client";
import { EmbeddingMap } from "./EmbeddingMap";
import type { MapPoints } from "./mapPoints";
import { withStates } from "./mapPoints";
import { somePoints } from "./testing";

const WIDTH = 400;
/** Shapes 1 to 3 in a line, of clusters 0, 0 and 1; the second is in the middle. */
const points: MapPoints = { ...somePoints([-1, 0, 1], [0, 0, 0]), cluster: Int32Array.of(0, 0, 1) };

beforeEach(() => {
  vi.stubGlobal(
    "ResizeObserver",
    class {
      observe() {}
      disconnect() {}
    },
  );
  vi.stubGlobal("matchMedia", () => ({ addEventListener() {}, removeEventListener() {} }));
  vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);
  vi.spyOn(HTMLElement.prototype, "clientWidth", "get").mockReturnValue(WIDTH);
  vi.spyOn(HTMLElement.prototype, "clientHeight", "get").mockReturnValue(WIDTH);
  HTMLElement.prototype.setPointerCapture = () => undefined;
  vi.spyOn(api, "GET").mockImplementation(((
    _path: string,
    options: { params: { path: { shape_id: number } } },
  ) => Promise.resolve({ data: { source_key: `${options.params.path.shape_id}.off` } })) as never);
});
afterEach(() => {
  cleanup();
  vi.restoreAllMocks();
  vi.unstubAllGlobals();
});

function shown(client = new QueryClient(), cluster: number | null = null) {
  const onChoose = vi.fn();
  const onShow = vi.fn();
  const map = (held: MapPoints) => (
    <QueryClientProvider client={client}>
      <EmbeddingMap
        points={held}
        collectionId={1}
        chosen={new Set()}
        cluster={cluster}
        mayOrder={false}
        onChoose={onChoose}
        onShow={onShow}
        onCluster={() => undefined}
      />
    </QueryClientProvider>
  );
  const { rerender, unmount } = render(map(points));
  const canvas = screen.getByRole("application");
  return { client, canvas, onChoose, onShow, unmount, take: (held: MapPoints) => rerender(map(held)) };
}

/** As a browser does where keys have brought the focus. */
function focusByKey(canvas: HTMLElement) {
  const matches = canvas.matches.bind(canvas);
  canvas.matches = (selector) => selector === ":focus-visible" || matches(selector);
  fireEvent.focus(canvas);
}

describe("EmbeddingMap", () => {
  it("Enter picks the shape under the crosshair, which is told by name", async () => {
    const { canvas, onChoose, onShow } = shown();
    focusByKey(canvas);
    await waitFor(() => expect(screen.getByRole("status").textContent).toBe("2.off, Cluster 1, New"));
    fireEvent.keyDown(canvas, { key: "Enter" });
    expect(onChoose).toHaveBeenLastCalledWith([2], false);
    expect(onShow).toHaveBeenLastCalledWith(2);
  });

  it("keys that move the map bring another shape under the crosshair", async () => {
    const { canvas, onChoose } = shown();
    focusByKey(canvas);
    for (let i = 0; i < 3; i++) fireEvent.keyDown(canvas, { key: "ArrowRight" });
    await waitFor(() => expect(screen.getByRole("status").textContent).toBe("3.off, Cluster 2, New"));
    fireEvent.keyDown(canvas, { key: "Enter", shiftKey: true });
    expect(onChoose).toHaveBeenLastCalledWith([3], true);
  });

  it("without the focus nothing is aimed at", () => {
    const { canvas } = shown();
    focusByKey(canvas);
    expect(screen.queryByRole("status")).not.toBeNull();
    fireEvent.blur(canvas);
    expect(screen.queryByRole("status")).toBeNull();
  });

  it("what is in view is selected by a button", () => {
    const { canvas, onChoose } = shown();
    for (let i = 0; i < 3; i++) fireEvent.keyDown(canvas, { key: "+" });
    fireEvent.click(screen.getByRole("button", { name: "Select what is in view" }));
    expect(onChoose).toHaveBeenLastCalledWith([2], false);
  });

  it("so is the cluster that the list is limited to", () => {
    const { onChoose } = shown(new QueryClient(), 0);
    fireEvent.click(screen.getByRole("button", { name: "Select cluster 1" }));
    expect(onChoose).toHaveBeenLastCalledWith([1, 2], false);
  });

  it("a shape that is touched stays to be looked at once the finger is lifted", async () => {
    const { canvas, onChoose } = shown();
    const touch = { pointerType: "touch", pointerId: 1, button: 0, clientX: WIDTH / 2, clientY: WIDTH / 2 };
    fireEvent.pointerDown(canvas, touch);
    fireEvent.pointerUp(canvas, touch);
    fireEvent.pointerLeave(canvas, touch);
    expect(onChoose).toHaveBeenLastCalledWith([2], false);
    await waitFor(() => expect(screen.queryByText("2.off")).not.toBeNull());
  });

  it("stays as it is looked at when states change, and when it is opened again", () => {
    const { client, canvas, take, unmount } = shown();
    const chooseView = (chosen: ReturnType<typeof vi.fn>) => {
      fireEvent.click(screen.getByRole("button", { name: "Select what is in view" }));
      return chosen.mock.lastCall?.[0];
    };
    for (let i = 0; i < 3; i++) fireEvent.keyDown(canvas, { key: "+" });
    fireEvent.click(screen.getByRole("radio", { name: "States" }));
    take(withStates(points, new Map([[1, "confirmed"]])));
    expect(screen.getByRole("list", { name: "States" })).not.toBeNull();
    unmount();
    const again = shown(client);
    expect(screen.getByRole("list", { name: "States" })).not.toBeNull();
    expect(chooseView(again.onChoose)).toEqual([2]);
  });

  it("shows all again where points that were placed anew would leave nothing in view", () => {
    const { canvas, take, onChoose } = shown();
    for (let i = 0; i < 3; i++) fireEvent.keyDown(canvas, { key: "+" });
    take(somePoints([100, 200], [100, 100]));
    fireEvent.click(screen.getByRole("button", { name: "Select what is in view" }));
    expect(onChoose).toHaveBeenLastCalledWith([1, 2], false);
  });
});
