// @vitest-environment jsdom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { SurfaceMesh } from "../geometry/surfaceMesh";
import type { ViewListener } from "./gesturedView";
import { meshOf } from "./preparedMesh";
import { builtTree, readTree } from "./searchTree";
import { type Hit, ShapeModel } from "./shapeModel";
import { ShapeView } from "./shapeView";
import { preparedSurface } from "./surfacePreparation";

const SIZE = 200;
const [INSIDE, BESIDE] = [100, 3];

/** A square of 8 × 8 cells in the plane of the screen: its front fills most of the view. */
function square(): SurfaceMesh {
  const n = 8;
  const vertices: number[] = [];
  const faces: number[] = [];
  for (let j = 0; j <= n; j += 1) for (let i = 0; i <= n; i += 1) vertices.push(i, j, 0);
  for (let j = 0; j < n; j += 1) {
    for (let i = 0; i < n; i += 1) {
      const a = j * (n + 1) + i;
      faces.push(a, a + 1, a + n + 2, a, a + n + 2, a + n + 1);
    }
  }
  return new SurfaceMesh(Float32Array.from(vertices), Uint32Array.from(faces), "square");
}

const mesh = square();
const model = new ShapeModel(meshOf(preparedSurface(mesh), mesh.hash));
model.pickWith(readTree(builtTree(mesh), mesh));
let view: ShapeView;
let told: string[];
let hits: Hit[];
const stage = { invalidate: vi.fn(), inputAt: vi.fn(), moved: vi.fn(), removed: vi.fn() };

beforeEach(() => {
  vi.clearAllMocks();
  const element = document.createElement("div");
  element.tabIndex = 0;
  element.getBoundingClientRect = () => new DOMRect(0, 0, SIZE, SIZE);
  element.setPointerCapture = () => undefined; // jsdom has none
  document.body.append(element);
  view = new ShapeView(element, { up: "y" }, stage);
  view.show(model);
  view.frame("front");
  view.tool = "stroke";
  told = [];
  hits = [];
  const listener: ViewListener = {
    hover: (hit) => told.push(hit === null ? "left" : "hover"),
    strokeStart: (hit) => {
      told.push("start");
      hits.push(hit);
    },
    strokeMove: (more) => {
      told.push("move");
      hits.push(...more);
    },
    strokeEnd: () => told.push("end"),
    strokeCancel: () => told.push("cancel"),
  };
  view.listen(listener);
});

afterEach(() => view.remove());

function pointer(type: string, x: number, y: number, options: PointerEventInit = {}): void {
  view.element.dispatchEvent(new PointerEvent(type, { clientX: x, clientY: y, pointerId: 1, ...options }));
}

describe("picking", () => {
  it("finds the face under a point of the page", () => {
    const hit = view.pick(INSIDE + 5, INSIDE - 4);
    const [x, y, z] = hit?.point ?? [0, 0, 1];
    expect([x > 4, y > 4, Math.abs(z) < 1e-6]).toEqual([true, true, true]);
    expect(hit?.face).toBe(2 * (4 * 8 + 4)); // the cell right above the middle, its lower half
  });

  it("finds nothing beside the shape, outside the view, or without a shape", () => {
    expect([view.pick(BESIDE, BESIDE), view.pick(-50, INSIDE)]).toEqual([null, null]);
    view.show(null);
    expect(view.pick(INSIDE, INSIDE)).toBeNull();
  });

  it("in the middle is for keys", () => {
    expect(view.centreHit()).toEqual(view.pick(INSIDE, INSIDE));
  });
});

describe("a stroke", () => {
  it("follows the pointer from face to face, also where it went fast", () => {
    pointer("pointerdown", 40, INSIDE + 3);
    pointer("pointermove", 160, INSIDE + 3);
    pointer("pointerup", 160, INSIDE + 3);
    expect(told.filter((what) => what !== "hover")).toEqual(["start", "move", "end"]);
    const cells = new Set(hits.map(({ face }) => Math.floor(face / 2)));
    expect([...cells]).toEqual([25, 26, 27, 28, 29, 30]); // every cell on the way, in order
  });

  it("tells of faces as far apart as wished", () => {
    view.strokeSpacing = 0.25;
    pointer("pointerdown", 40, INSIDE + 3);
    pointer("pointermove", 160, INSIDE + 3);
    const xs = hits.map(({ point }) => point[0]);
    for (let k = 1; k < xs.length; k += 1) {
      expect((xs[k] as number) - (xs[k - 1] as number)).toBeGreaterThanOrEqual(0.25 * model.mesh.diagonal);
    }
    expect(xs.length).toBeGreaterThan(1);
  });

  it.each(["Escape", "a second finger", "the browser"])("is given up by %s", (who) => {
    pointer("pointerdown", INSIDE, INSIDE, { pointerType: "touch" });
    if (who === "Escape") view.element.dispatchEvent(new KeyboardEvent("keydown", { key: "Escape" }));
    if (who === "a second finger") pointer("pointerdown", 120, 120, { pointerId: 2, pointerType: "touch" });
    if (who === "the browser") pointer("pointercancel", INSIDE, INSIDE);
    pointer("pointerup", INSIDE, INSIDE, { pointerType: "touch" });
    expect(told).toEqual(["start", "cancel"]);
  });

  it("is given up when another shape comes, and what its pointer does then neither draws nor turns", () => {
    pointer("pointerdown", INSIDE, INSIDE);
    view.show(model.alike());
    const { pose } = view;
    pointer("pointermove", 120, 120);
    pointer("pointerup", 120, 120);
    expect(told.filter((what) => what !== "hover")).toEqual(["start", "cancel"]);
    expect(view.pose).toBe(pose);
  });

  it.each([
    ["beside the shape", BESIDE, {}],
    ["with the right button", INSIDE, { button: 2 }],
    ["with Alt", INSIDE, { altKey: true }],
  ])("is not begun %s: that turns", (_, at, options) => {
    const before = view.pose.orientation.clone();
    pointer("pointerdown", at, at, options);
    pointer("pointermove", at + 30, at);
    expect(hits).toEqual([]);
    expect(view.pose.orientation.angleTo(before)).toBeGreaterThan(0.1);
  });

  it("is not begun where the tool is to navigate", () => {
    view.tool = "navigate";
    pointer("pointerdown", INSIDE, INSIDE);
    expect(hits).toEqual([]);
  });
});

describe("the camera", () => {
  it.each([
    ["the middle button", { button: 1 }],
    ["Shift", { shiftKey: true }],
  ])("moves with %s, and what was under the pointer stays there", (_, options) => {
    const before = view.pick(INSIDE, INSIDE)?.point ?? [];
    pointer("pointerdown", INSIDE, INSIDE, options);
    pointer("pointermove", INSIDE + 20, INSIDE + 10);
    const after = view.pick(INSIDE + 20, INSIDE + 10)?.point ?? [];
    expect(Math.hypot(...before.map((value, axis) => value - (after[axis] as number)))).toBeLessThan(1e-5);
  });

  it("zooms to where the wheel is turned", () => {
    const before = view.pick(60, 70)?.point ?? [];
    const { distance } = view.pose;
    view.element.dispatchEvent(
      new WheelEvent("wheel", { clientX: 60, clientY: 70, deltaY: -200, cancelable: true }),
    );
    const after = view.pick(60, 70)?.point ?? [];
    expect(view.pose.distance).toBeLessThan(distance);
    expect(Math.hypot(...before.map((value, axis) => value - (after[axis] as number)))).toBeLessThan(1e-5);
  });

  it("comes nearer when two fingers part", () => {
    const { distance } = view.pose;
    pointer("pointerdown", 90, INSIDE, { pointerId: 1, pointerType: "touch" });
    pointer("pointerdown", 110, INSIDE, { pointerId: 2, pointerType: "touch" });
    pointer("pointermove", 130, INSIDE, { pointerId: 2, pointerType: "touch" });
    expect(view.pose.distance).toBeCloseTo(distance / 2, 6);
  });

  it.each(["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "+", "-"])("obeys the key %s", (key) => {
    const { orientation, distance } = view.pose;
    view.element.dispatchEvent(new KeyboardEvent("keydown", { key, cancelable: true }));
    const hasTurned = view.pose.orientation.angleTo(orientation) > 0.05;
    expect(hasTurned || view.pose.distance !== distance).toBe(true);
  });

  it("leaves keys that are meant for the browser or for something in the view", () => {
    const { pose } = view;
    view.element.dispatchEvent(new KeyboardEvent("keydown", { key: "+", ctrlKey: true }));
    view.element.dispatchEvent(new KeyboardEvent("keydown", { key: "-", code: "Digit6" })); // French
    const button = view.element.appendChild(document.createElement("button"));
    button.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
    expect(view.pose).toBe(pose);
  });

  it("frames the shape on Home, and another shape by itself", () => {
    const { pose } = view;
    view.zoom(0.2);
    view.element.dispatchEvent(new KeyboardEvent("keydown", { key: "Home", cancelable: true }));
    expect(view.pose.distance).toBeCloseTo(pose.distance, 12);
  });

  it("fits the shape into another size, unless it was turned or moved", () => {
    const { distance } = view.pose;
    view.element.getBoundingClientRect = () => new DOMRect(0, 0, SIZE / 2, SIZE);
    view.fit();
    expect(view.pose.distance).toBeCloseTo(2 * distance, 3);
    view.zoom(0.5);
    const moved = view.pose;
    view.fit();
    expect(view.pose).toBe(moved);
  });

  it("tells its stage when it leads, not when it follows", () => {
    stage.moved.mockClear();
    view.follow({ ...view.pose, distance: 1 });
    expect(stage.moved).not.toHaveBeenCalled();
    view.turn(0.1, 0);
    expect(stage.moved).toHaveBeenCalledWith(view);
  });
});

describe("hovering", () => {
  it("is told over the surface, and once when it ends", () => {
    pointer("pointermove", INSIDE, INSIDE);
    pointer("pointermove", BESIDE, BESIDE);
    pointer("pointerleave", BESIDE, BESIDE);
    expect(told).toEqual(["hover", "left"]);
  });

  it.each([
    ["is lifted", "pointerup", 1],
    ["is taken away by the browser", "pointercancel", 1],
    ["is joined by a second one", "pointerdown", 2],
  ])("ends when a finger that drew %s, as none hovers", (_, type, pointerId) => {
    pointer("pointerdown", INSIDE, INSIDE, { pointerType: "touch" });
    pointer("pointermove", INSIDE + 20, INSIDE, { pointerType: "touch" });
    pointer(type, INSIDE + 20, INSIDE, { pointerType: "touch", pointerId });
    expect(told.filter((what) => what === "hover" || what === "left")).toEqual(["hover", "left"]);
  });
});

describe("a shape in two views", () => {
  it("is still drawn anew in one after it has left the other", () => {
    const other = new ShapeView(document.createElement("div"), { up: "y" }, stage);
    other.show(model);
    view.show(null);
    stage.invalidate.mockClear();
    model.setWireframe(true);
    expect(stage.invalidate).toHaveBeenCalledOnce();
    other.remove();
  });
});

describe("a view that was removed", () => {
  it("hears nothing more", () => {
    view.remove();
    pointer("pointermove", INSIDE, INSIDE);
    expect(told).toEqual([]);
    expect(stage.removed).toHaveBeenCalledWith(view);
    expect(model.changed.size).toBe(0);
  });
});
