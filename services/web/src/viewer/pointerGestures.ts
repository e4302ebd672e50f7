/**
 * What mouse, pen and fingers do to a view: strokes on the surface, and moving the camera.
 *
 * Left button, pen or one finger on the surface draws if the view's tool is `stroke`; beside it, with Alt, with the right
 * button, or if the tool is `navigate`, it turns. The middle button, or Shift, moves. Two fingers move and zoom.
 */

import type { GesturedView } from "./gesturedView";
import { Strokes } from "./strokeGesture";

const TURN_PER_PIXEL = 0.008;
const ZOOM_PER_PIXEL = 0.0016;
const PIXELS_PER_LINE = 18;

type Point = { x: number; y: number };

export class PointerGestures {
  readonly #view: GesturedView;
  readonly #pressed = new Map<number, Point>();
  readonly #strokes: Strokes;
  readonly #listening = new AbortController();
  #isMoving = false;
  #isHovering = false;

  constructor(view: GesturedView) {
    this.#view = view;
    this.#strokes = new Strokes(view);
    const { element } = view;
    const { signal } = this.#listening;
    element.style.touchAction = "none";
    element.addEventListener("pointerdown", this.#down, { signal });
    element.addEventListener("pointermove", this.#move, { signal });
    element.addEventListener("pointerup", this.#up, { signal });
    element.addEventListener("pointercancel", this.#cancel, { signal });
    element.addEventListener("pointerleave", this.#leave, { signal });
    element.addEventListener("wheel", this.#wheel, { signal, passive: false });
    element.addEventListener("contextmenu", (event) => event.preventDefault(), { signal });
    element.addEventListener("keydown", this.#key, { signal });
  }

  /** A button or a finger is down. */
  get isPressed(): boolean {
    return this.#pressed.size > 0;
  }

  /** Gives up a drag that is under way; what its pointer does until it is lifted is none of it. */
  giveUpStroke(): void {
    if (!this.#strokes.isDrawing) return;
    this.#pressed.clear();
    this.#strokes.cancel();
  }

  remove(): void {
    this.giveUpStroke();
    this.#listening.abort();
  }

  readonly #down = (event: PointerEvent) => {
    this.#view.element.focus({ preventScroll: true });
    this.#view.element.setPointerCapture(event.pointerId);
    this.#pressed.set(event.pointerId, pointOf(event));
    if (this.#pressed.size > 1) {
      this.#strokes.cancel();
      this.#stopHovering(event);
      return;
    }
    this.#isMoving = event.button === 1 || event.shiftKey;
    const mayDraw = this.#view.tool === "stroke" && event.button === 0 && !event.altKey && !event.shiftKey;
    const hit = mayDraw ? this.#view.pick(event.clientX, event.clientY) : null;
    if (hit !== null) this.#strokes.start(hit, event);
    else this.#stopHovering(event);
  };

  readonly #move = (event: PointerEvent) => {
    const before = this.#pressed.get(event.pointerId);
    if (before === undefined) return this.#hover(event);
    if (this.#strokes.isDrawing) {
      this.#hover(event);
      return this.#strokes.move(event);
    }
    const now = pointOf(event);
    if (this.#pressed.size === 2) this.#pinch(event.pointerId, before, now);
    else if (this.#isMoving) this.#shift(before, now);
    else if (this.#pressed.size === 1) {
      this.#view.turn((now.x - before.x) * TURN_PER_PIXEL, (now.y - before.y) * TURN_PER_PIXEL);
    }
    this.#pressed.set(event.pointerId, now);
  };

  readonly #up = (event: PointerEvent) => {
    this.#pressed.delete(event.pointerId);
    this.#strokes.end();
    if (event.pointerType === "touch") this.#stopHovering(event);
    else this.#hover(event);
  };

  readonly #cancel = (event: PointerEvent) => {
    this.#pressed.delete(event.pointerId);
    this.#strokes.cancel();
    this.#stopHovering(event);
  };

  readonly #leave = (event: PointerEvent) => this.#stopHovering(event);

  readonly #key = (event: KeyboardEvent) => {
    if (event.key !== "Escape" || !this.#strokes.isDrawing) return;
    event.stopPropagation();
    this.giveUpStroke();
  };

  readonly #wheel = (event: WheelEvent) => {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? PIXELS_PER_LINE : 1);
    const isPinch = event.ctrlKey; // how browsers tell of a pinch on a touchpad
    this.#view.zoom(Math.exp(pixels * ZOOM_PER_PIXEL * (isPinch ? 6 : 1)), event.clientX, event.clientY);
  };

  #hover(event: PointerEvent): void {
    const hit = this.#view.pick(event.clientX, event.clientY);
    if (hit === null) this.#stopHovering(event);
    else {
      this.#isHovering = true;
      this.#view.tell((listener) => listener.hover?.(hit, event), event.timeStamp);
    }
  }

  #stopHovering(event: PointerEvent): void {
    if (!this.#isHovering) return;
    this.#isHovering = false;
    this.#view.tell((listener) => listener.hover?.(null, event));
  }

  #shift(before: Point, now: Point): void {
    const { height } = this.#view.element.getBoundingClientRect();
    this.#view.move((now.x - before.x) / height, -(now.y - before.y) / height);
  }

  /** One of two fingers went from `before` to `now`. */
  #pinch(pointerId: number, before: Point, now: Point): void {
    const other = [...this.#pressed].find(([id]) => id !== pointerId)?.[1];
    if (other === undefined) return;
    const spread = Math.hypot(now.x - other.x, now.y - other.y);
    const middle = { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 };
    this.#shift({ x: (before.x + other.x) / 2, y: (before.y + other.y) / 2 }, middle);
    if (spread > 0) {
      this.#view.zoom(Math.hypot(before.x - other.x, before.y - other.y) / spread, middle.x, middle.y);
    }
  }
}

function pointOf(event: PointerEvent): Point {
  return { x: event.clientX, y: event.clientY };
}
