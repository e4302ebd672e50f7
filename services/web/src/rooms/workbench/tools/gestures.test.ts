import { beforeEach, describe, expect, it } from "vitest";
import { Observable } from "../../../drafts/observable";
import { SurfaceMesh } from "../../../geometry/surfaceMesh";
import type { Operation } from "../../../labels/operations";
import type { BrushCircle, Hit, ShapeModel } from "../../../viewer/shapeModel";
import type { ShapeView } from "../../../viewer/shapeView";
import type { OpenShape } from "../shape/openShape";
import { ToolGestures } from "./gestures";
import { PatchMap } from "./patchMap";
import { ToolShelf } from "./toolSettings";

const N_FACES = 40;
const NARROW = 0.004;
const WIDE = 0.3;
const N_PATCHES = 10;

interface Shown {
  preview: readonly number[];
  brush: BrushCircle | null;
}

/** A shape in the view, what shows on it, and what was done to it. */
interface FakeShape {
  readonly model: ShapeModel;
  readonly shown: Shown;
  readonly labels: Uint16Array;
  readonly done: Operation[];
  readonly perform: (operation: Operation) => void;
  readonly version: Observable<number>;
  canEdit: boolean;
}

let shelf: ToolShelf;
let gestures: ToolGestures;
let view: { model: ShapeModel; tool?: string; centreHit: () => Hit | null };
let isDrawnOn: boolean;
let open: FakeShape;
let another: FakeShape;

/** A strip of triangles along x. */
function strip(): SurfaceMesh {
  const vertices = Float32Array.from({ length: 3 * (N_FACES + 2) }, (_, at) => {
    const vertex = Math.floor(at / 3);
    return [vertex / 2, vertex % 2, 0][at % 3] as number;
  });
  const faces = Uint32Array.from({ length: 3 * N_FACES }, (_, at) => Math.floor(at / 3) + (at % 3));
  return new SurfaceMesh(vertices, faces, "strip");
}

function fakeShape(): FakeShape {
  const shown: Shown = { preview: [], brush: null };
  const model = {
    mesh: strip(),
    setBrush: (circle: BrushCircle | null) => {
      shown.brush = circle;
    },
    setPreview: (faces: Uint32Array | null) => {
      shown.preview = [...(faces ?? [])];
    },
    addPreview: (faces: Uint32Array) => {
      shown.preview = [...shown.preview, ...faces];
    },
  } as unknown as ShapeModel;
  const done: Operation[] = [];
  const perform = (operation: Operation) => void done.push(operation);
  const version = new Observable(0);
  return { model, shown, done, perform, version, labels: new Uint16Array(N_FACES), canEdit: true };
}

/** Another shape comes into the view. */
function showAnother(): void {
  open = another;
  view.model = another.model;
}

const hitOf = (face: number): Hit => ({ face, point: [face / 2, 0.5, 0] });

beforeEach(() => {
  [open, another] = [fakeShape(), fakeShape()];
  shelf = new ToolShelf({ getItem: () => null, setItem: () => undefined });
  shelf.change({ tool: "paint", radius: NARROW });
  isDrawnOn = true;
  view = { model: open.model, centreHit: () => null };
  const patches = new PatchMap(Uint32Array.from({ length: N_FACES }, (_, face) => face % N_PATCHES));
  gestures = new ToolGestures(view as unknown as ShapeView, {
    shelf,
    isDrawnOn: () => isDrawnOn,
    open: () => (isDrawnOn ? (open as unknown as OpenShape) : null),
    patches: () => patches,
    colourOf: () => "#0072b2",
    onEngage: () => undefined,
  });
});

describe("the brush over the surface", () => {
  it("shows what a click would take", () => {
    gestures.hover(hitOf(20));
    expect(open.shown.preview).toEqual([20]);
    expect(open.shown.brush?.radius).toBe(NARROW);
  });

  it("shows nothing beside the surface", () => {
    gestures.hover(hitOf(20));
    gestures.hover(null);
    expect(open.shown).toEqual({ preview: [], brush: null });
  });

  it("keeps to the part that it paints over", () => {
    shelf.change({ radius: WIDE, onlyOver: 0 });
    open.labels.fill(2, 22);
    gestures.hover(hitOf(20));
    expect(open.shown.preview).toContain(21);
    expect(open.shown.preview).not.toContain(22);
  });

  it("promises nothing where nothing may be changed", () => {
    open.canEdit = false;
    gestures.hover(hitOf(20));
    expect(open.shown.preview).toEqual([]);
  });

  it("grows with its key where the pointer rests", () => {
    gestures.hover(hitOf(20));
    shelf.change({ radius: WIDE });
    gestures.adopt();
    expect(open.shown.brush?.radius).toBe(WIDE);
    expect(open.shown.preview.length).toBeGreaterThan(5);
  });

  it("keeps what a drag has taken while its size changes", () => {
    gestures.strokeStart(hitOf(3));
    gestures.strokeMove([hitOf(30)]);
    shelf.change({ radius: WIDE });
    gestures.adopt();
    gestures.hover(hitOf(30));
    expect(open.shown.preview).toEqual([3, 30]);
  });
});

describe("a drag", () => {
  it("is done to the shape that it began on, once it ends", () => {
    gestures.strokeStart(hitOf(3));
    gestures.strokeMove([hitOf(30)]);
    expect(open.done).toEqual([]);
    gestures.strokeEnd();
    expect(open.done).toMatchObject([{ kind: "paint", seeds: [3, 30], label: 1 }]);
    expect(open.shown.preview).toEqual([]);
  });

  it("over patches gives them the part in hand when it began", () => {
    shelf.change({ tool: "patches", part: 2 });
    gestures.strokeStart(hitOf(4));
    shelf.change({ part: 3 });
    gestures.strokeMove([hitOf(14), hitOf(5)]); // of the same patch, of the next one
    expect(open.shown.preview).toEqual([4, 14, 24, 34, 5, 15, 25, 35]);
    gestures.strokeEnd();
    const runs = [4, 14, 24, 34].map((face) => [face, 2]);
    expect(open.done).toEqual([{ kind: "assign", runs, label: 2 }]);
  });

  it.each(["paint", "patches"] as const)("ends with its shape: the next one takes nothing of %s", (tool) => {
    const first = open;
    shelf.change({ tool });
    gestures.strokeStart(hitOf(3));
    showAnother();
    gestures.strokeMove([hitOf(30)]);
    expect([first.shown.preview, another.shown.preview]).toEqual([[], []]);
    gestures.strokeEnd();
    expect([first.done, another.done]).toEqual([[], []]);
  });

  it.each(["before it goes on", "before it ends"])(
    "is dropped if nothing may be changed any more %s",
    (when) => {
      gestures.strokeStart(hitOf(3));
      open.canEdit = false;
      if (when === "before it goes on") gestures.strokeMove([hitOf(30)]);
      open.canEdit = when === "before it goes on"; // it does not come back with the right to
      gestures.strokeEnd();
      expect([open.done, open.shown.preview]).toEqual([[], []]);
    },
  );

  it("that is given up leaves nothing where it was", () => {
    const first = open;
    gestures.strokeStart(hitOf(3));
    showAnother();
    gestures.strokeCancel();
    expect(first.shown.preview).toEqual([]);
  });
});

describe("a press", () => {
  beforeEach(() => open.labels.fill(2, 20));

  it("gives its whole segment the part in hand once it ends, wherever it is let go", () => {
    shelf.change({ tool: "segment", part: 3 });
    gestures.strokeStart(hitOf(4));
    gestures.strokeMove([hitOf(30), hitOf(4)]);
    expect(open.done).toEqual([]);
    gestures.strokeEnd();
    expect(open.done).toEqual([{ kind: "segment_wide", seed: 4, label: 3 }]);
    expect(open.shown.preview).toEqual([]);
  });

  it("shows the segment that it will take", () => {
    shelf.change({ tool: "segment" });
    gestures.strokeStart(hitOf(20));
    expect(open.shown.preview.toSorted((a, b) => a - b)).toEqual(
      Array.from({ length: 20 }, (_, at) => 20 + at),
    );
  });

  it("picks the part under it once it ends", () => {
    shelf.change({ tool: "pick" });
    gestures.strokeStart(hitOf(30));
    expect(shelf.settings.get().tool).toBe("pick");
    gestures.strokeEnd();
    expect(shelf.settings.get()).toMatchObject({ tool: "paint", part: 2 });
  });

  it.each(["segment", "pick"] as const)("that a second finger makes a pinch does nothing with %s", (tool) => {
    shelf.change({ tool });
    const before = shelf.settings.get();
    gestures.strokeStart(hitOf(30));
    gestures.strokeCancel();
    gestures.strokeEnd();
    expect([open.done, open.shown.preview]).toEqual([[], []]);
    expect(shelf.settings.get()).toEqual(before);
  });

  it("of a key acts at the middle of the view", () => {
    view.centreHit = () => hitOf(30);
    shelf.change({ tool: "segment", part: 3 });
    expect(gestures.pressAtCentre()).toBeNull();
    expect(open.done).toEqual([{ kind: "segment_wide", seed: 30, label: 3 }]);
    shelf.change({ tool: "pick" });
    expect(gestures.pressAtCentre()).toBeNull();
    expect(shelf.settings.get()).toMatchObject({ tool: "paint", part: 2 });
  });
});

describe("a view", () => {
  it("is turned rather than drawn on while it shows something to compare with", () => {
    gestures.adopt();
    expect(view.tool).toBe("stroke");
    isDrawnOn = false;
    gestures.adopt();
    expect(view.tool).toBe("navigate");
  });

  it("leaves no brush on the draft, which other views go on showing", () => {
    gestures.hover(hitOf(20));
    isDrawnOn = false;
    gestures.adopt();
    expect(open.shown).toEqual({ preview: [], brush: null });
  });

  it("leaves nothing on a shape that has gone from it", () => {
    const first = open;
    gestures.hover(hitOf(20));
    showAnother();
    gestures.adopt();
    expect(first.shown).toEqual({ preview: [], brush: null });
    expect(another.shown).toEqual({ preview: [], brush: null });
  });

  it("says why a key presses nothing at its middle", () => {
    expect(gestures.pressAtCentre()).toContain("no surface");
    isDrawnOn = false;
    expect(gestures.pressAtCentre()).toContain("to look at");
  });
});
