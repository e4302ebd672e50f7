/** Between a view and what moves it: what pointer and keys need of it, and what it tells whoever works with it. */
import type { Pose } from "./pose";
import type { Hit, ShapeModel } from "./shapeModel";

/** A view as pointer and keys know it. */
export interface GesturedView {
  readonly element: HTMLElement;
  /** `stroke`: pressing on the surface draws. `navigate`: every gesture moves the camera. */
  readonly tool: "navigate" | "stroke";
  /** Least distance between hits of a drag, as a share of the diagonal: a quarter of the brush's radius, say. */
  readonly strokeSpacing: number;
  readonly model: ShapeModel | null;
  turn(right: number, down: number): void;
  /** By heights of the view. */
  move(right: number, up: number): void;
  /** Nearer (factor < 1) or farther, about a point of the page or the middle. */
  zoom(factor: number, clientX?: number, clientY?: number): void;
  /** The whole shape closely in view. */
  frame(): void;
  /** What is at a point of the page; null beside the shape. */
  pick(clientX: number, clientY: number): Hit | null;
  /** Passes something on to all listeners. inputAt : of the event behind it, to tell how soon its picture came. */
  tell(what: (listener: ViewListener) => void, inputAt?: number): void;
}

/** What a view tells whoever works with it. */
export interface ViewListener {
  /** The pointer is over the surface, or (null) no longer. */
  hover?(hit: Hit | null, event: PointerEvent): void;
  strokeStart?(hit: Hit, event: PointerEvent): void;
  /** Further hits of a drag, in order; a face is told once in a row. */
  strokeMove?(hits: readonly Hit[], event: PointerEvent): void;
  strokeEnd?(): void;
  /** The drag was given up (Escape, a second finger, another shape in the view): nothing of it counts. */
  strokeCancel?(): void;
  cameraChange?(pose: Pose): void;
}
