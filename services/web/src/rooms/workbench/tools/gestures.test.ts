import { beforeEach, describe, expect, it } from "vitest";
import { SurfaceMesh } from "../../../geometry/surfaceMesh";
import type { BrushCircle, Hit, ShapeModel } from "../../../viewer/shapeModel";
import type { ShapeView } from "../../../viewer/shapeView";
import type { OpenShape } from "../shape/openShape";
import { ToolGestures } from "./gestures";
import { ToolShelf } from "./toolSettings";

const N_FACES = 40;
const NARROW = 0.004;
const WIDE = 0.3;
let preview: readonly number[];
let brush: BrushCircle | null;
let shelf: ToolShelf;
let gestures: ToolGestures;
let view: ShapeView;
let isDrawnOn: boolean;
let open: { labels: Uint16Array; canEdit: boolean };

/** A strip of triangles along x. */
function strip(): SurfaceMesh {
  const vertices = Float32Array.from({ length: 3 * (N_FACES + 2) }, (_, at) => {
    const vertex = Math.floor(at / 3);
    return [vertex / 2, vertex % 2, 0][at % 3] as number;
  });
  const faces = Uint32Array.from({ length: 3 * N_FACES }, (_, at) => Math.floor(at / 3) + (at % 3));
  return new SurfaceMesh(vertices, faces, "strip");
}

const hitOf = (face: number): Hit => ({ face, point: [face / 2, 0.5, 0] });

beforeEach(() => {
  preview = [];
  brush = null;
  const model = {
    mesh: strip(),
    setBrush: (circle: BrushCircle | null) => {
      brush = circle;
    },
    setPreview: (faces: Uint32Array | null) => {
      preview = [...(faces ?? [])];
    },
    addPreview: (faces: Uint32Array) => {
      preview = [...preview, ...faces];
    },
  } as unknown as ShapeModel;
  open = { labels: new Uint16Array(N_FACES), canEdit: true };
  shelf = new ToolShelf({ getItem: () => null, setItem: () => undefined });
  shelf.change({ tool: "paint", radius: NARROW });
  isDrawnOn = true;
  view = { model, centreHit: () => null } as unknown as ShapeView;
  gestures = new ToolGestures(view, {
    shelf,
    isDrawnOn: () => isDrawnOn,
    open: () => (isDrawnOn ? ({ ...open, model } as unknown as OpenShape) : null),
    patches: () => null,
    colourOf: () => "#0072b2",
    onEngage: () => undefined,
  });
});

describe("the brush over the surface", () => {
  it("shows what a click would take", () => {
    gestures.hover(hitOf(20));
    expect(preview).toEqual([20]);
    expect(brush?.radius).toBe(NARROW);
  });

  it("shows nothing beside the surface", () => {
    gestures.hover(hitOf(20));
    gestures.hover(null);
    expect([preview, brush]).toEqual([[], null]);
  });

  it("keeps to the part that it paints over", () => {
    shelf.change({ radius: WIDE, onlyOver: 0 });
    open.labels.fill(2, 22);
    gestures.hover(hitOf(20));
    expect(preview).toContain(21);
    expect(preview).not.toContain(22);
  });

  it("promises nothing where nothing may be changed", () => {
    open.canEdit = false;
    gestures.hover(hitOf(20));
    expect(preview).toEqual([]);
  });

  it("grows with its key where the pointer rests", () => {
    gestures.hover(hitOf(20));
    shelf.change({ radius: WIDE });
    gestures.adopt();
    expect(brush?.radius).toBe(WIDE);
    expect(preview.length).toBeGreaterThan(5);
  });

  it("keeps what a drag has taken while its size changes", () => {
    gestures.strokeStart(hitOf(3));
    gestures.strokeMove([hitOf(30)]);
    shelf.change({ radius: WIDE });
    gestures.adopt();
    gestures.hover(hitOf(30));
    expect(preview).toEqual([3, 30]);
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
    expect([preview, brush]).toEqual([[], null]);
  });

  it("says why a key presses nothing at its middle", () => {
    expect(gestures.pressAtCentre()).toContain("no surface");
    isDrawnOn = false;
    expect(gestures.pressAtCentre()).toContain("to look at");
  });
});
