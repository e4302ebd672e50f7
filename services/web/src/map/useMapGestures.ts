/** Pointer, wheel and keys on the map: move, zoom, draw a lasso or a rectangle, point at a shape. */
import { type KeyboardEvent, type PointerEvent, type RefObject, useEffect, useRef } from "react";
import { panned, toMap, zoomedAt } from "./camera";
import { type Place, pointsInside } from "./lasso";
import type { MapView } from "./MapView";

export type Tool = "move" | "lasso" | "rectangle";

export interface MapGestures {
  /** The shape under the pointer or, on a touch screen, the one that was last touched; -1 for none. */
  onHover(place: number): void;
  /** One shape was pointed at. */
  onPick(place: number, isAdding: boolean): void;
  /** Shapes were drawn around. */
  onEncircle(places: readonly number[], isAdding: boolean): void;
}

const WHEEL_ZOOM = 0.0016;
const KEY_ZOOM = 1.4;
const KEY_PAN_PX = 60;
const PANS: ReadonlyMap<string, [number, number]> = new Map([
  ["ArrowLeft", [KEY_PAN_PX, 0]],
  ["ArrowRight", [-KEY_PAN_PX, 0]],
  ["ArrowUp", [0, KEY_PAN_PX]],
  ["ArrowDown", [0, -KEY_PAN_PX]],
]);
const ZOOMS: ReadonlyMap<string, number> = new Map([
  ["+", KEY_ZOOM],
  ["=", KEY_ZOOM],
  ["-", 1 / KEY_ZOOM],
]);
/** A pointer that moves less than this points. */
const STILL_PX = 4;
const REACH_PX = 8;
/** Keys move in steps, so that they aim less closely than a pointer. */
const AIM_PX = 40;

interface Drag {
  readonly start: readonly [number, number];
  readonly outline: Place[];
  isMoved: boolean;
}

export function useMapGestures(
  view: MapView,
  canvas: RefObject<HTMLCanvasElement | null>,
  tool: Tool,
  gestures: MapGestures,
) {
  const drag = useRef<Drag | null>(null);
  const pointers = useRef(new Map<number, readonly [number, number]>());
  const zoom = (at: readonly [number, number], factor: number) =>
    view.look(zoomedAt(view.camera, view.size, at, factor, view.homeCamera));
  const placeAt = ([px, py]: readonly [number, number]) => view.nearest(px, py, view.radius + REACH_PX);

  useEffect(() => {
    const element = canvas.current;
    if (!element) return undefined;
    const onWheel = (event: WheelEvent) => {
      event.preventDefault();
      const box = element.getBoundingClientRect();
      const at = [event.clientX - box.left, event.clientY - box.top] as const;
      view.look(zoomedAt(view.camera, view.size, at, Math.exp(-event.deltaY * WHEEL_ZOOM), view.homeCamera));
    };
    element.addEventListener("wheel", onWheel, { passive: false });
    return () => element.removeEventListener("wheel", onWheel);
  }, [canvas, view]);

  const end = (event: PointerEvent, isDropped: boolean) => {
    const ended = drag.current;
    pointers.current.delete(event.pointerId);
    drag.current = null;
    view.mark({ outline: [] });
    if (!ended || isDropped) return;
    const isAdding = event.shiftKey || event.ctrlKey || event.metaKey;
    if (!ended.isMoved) {
      const place = placeAt(ended.start);
      if (event.pointerType === "touch") gestures.onHover(place);
      gestures.onPick(place, isAdding);
    } else if (tool !== "move")
      gestures.onEncircle(pointsInside(view.points, view.grid, ended.outline), isAdding);
  };

  return {
    onPointerDown: (event: PointerEvent<HTMLCanvasElement>) => {
      if (event.button !== 0) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      const start = pointOf(event);
      pointers.current.set(event.pointerId, start);
      if (pointers.current.size > 1)
        drag.current = null; // two fingers zoom
      else drag.current = { start, outline: [toMap(view.camera, view.size, ...start)], isMoved: false };
    },
    onPointerMove: (event: PointerEvent<HTMLCanvasElement>) => {
      const at = pointOf(event);
      const before = pointers.current.get(event.pointerId);
      if (!before) {
        const place = placeAt(at);
        gestures.onHover(place);
        return;
      }
      if (pointers.current.size === 2) pinch(event.pointerId, before, at);
      pointers.current.set(event.pointerId, at);
      const begun = drag.current;
      if (!begun) return;
      begun.isMoved ||= Math.hypot(at[0] - begun.start[0], at[1] - begun.start[1]) > STILL_PX;
      if (!begun.isMoved) return;
      if (tool === "move") view.look(panned(view.camera, at[0] - before[0], at[1] - before[1]));
      else view.mark({ outline: grow(begun, at) });
    },
    onPointerUp: (event: PointerEvent) => end(event, false),
    onPointerCancel: (event: PointerEvent) => end(event, true),
    onPointerLeave: (event: PointerEvent) => {
      if (event.pointerType !== "touch") gestures.onHover(-1); // what was touched stays to be looked at
    },
    onKeyDown: (event: KeyboardEvent) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === "Enter") gestures.onPick(aimedAt(view), event.shiftKey);
      else if (!moveByKey(view, event.key)) return;
      event.preventDefault();
    },
  };

  function pinch(id: number, before: readonly [number, number], at: readonly [number, number]): void {
    const other = [...pointers.current].find(([each]) => each !== id)?.[1];
    if (!other) return;
    const factor =
      Math.hypot(at[0] - other[0], at[1] - other[1]) /
      Math.max(1, Math.hypot(before[0] - other[0], before[1] - other[1]));
    zoom([(at[0] + other[0]) / 2, (at[1] + other[1]) / 2], factor);
  }

  function grow(begun: Drag, at: readonly [number, number]): readonly Place[] {
    const here = toMap(view.camera, view.size, ...at);
    const [from] = begun.outline as [Place];
    if (tool === "lasso") begun.outline.push(here);
    else begun.outline.splice(1, 3, [here[0], from[1]], here, [from[0], here[1]]);
    return [...begun.outline];
  }
}

/** The shape that is nearest to the middle of the map, where keys pick; -1 if none is near. */
export function aimedAt(view: MapView): number {
  return view.nearest(view.size.width / 2, view.size.height / 2, AIM_PX);
}

/** Whether the key moves the map. */
function moveByKey(view: MapView, key: string): boolean {
  const pan = PANS.get(key);
  const factor = ZOOMS.get(key);
  if (pan) view.look(panned(view.camera, ...pan));
  else if (key === "0") view.goHome();
  else if (factor !== undefined) {
    const middle = [view.size.width / 2, view.size.height / 2] as const;
    view.look(zoomedAt(view.camera, view.size, middle, factor, view.homeCamera));
  } else return false;
  return true;
}

function pointOf(event: PointerEvent<HTMLCanvasElement>): readonly [number, number] {
  const box = event.currentTarget.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}
