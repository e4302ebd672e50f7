/**
 * One canvas and one graphics context for all viewports: browsers allow few contexts, and shapes shown twice are held
 * once. Draws only when something changed.
 */
import { type Graphics, newGraphics } from "./graphics";
import { ShapeView, type ViewOptions } from "./shapeView";

const MOST_PIXELS_TO_ONE = 2;
/** Without a graphics card: pixels to one while things move, and a finer picture once they have been still so long. */
const STILL_PIXELS_TO_ONE = 2;
const STILL_AFTER_MS = 500;

export class ShapeStage {
  /** Called when the browser takes the graphics context away, and when it is back and all is drawn anew. */
  onContext: ((state: "lost" | "restored") => void) | null = null;
  readonly #canvas: HTMLCanvasElement;
  readonly #graphics: Graphics;
  readonly #views = new Set<ShapeView>();
  readonly #resized: ResizeObserver;
  readonly #invalidate = () => this.invalidate();
  #links: readonly ShapeView[] = [];
  #frame = 0;
  #stillness: ReturnType<typeof setTimeout> | undefined;
  #inputAt: number | null = null;
  /** Nothing of the picture is right any more. */
  #isSpoilt = true;

  /** canvas : behind the elements of the views, at least as large as all of them. Throws NoWebGlError. */
  constructor(canvas: HTMLCanvasElement) {
    this.#canvas = canvas;
    this.#graphics = newGraphics(canvas);
    this.#resized = new ResizeObserver(() => {
      this.#isSpoilt = true;
      this.#draw(); // at once: a resized canvas is blank
    });
    this.#resized.observe(canvas);
    canvas.addEventListener("webglcontextlost", this.#contextLost);
    canvas.addEventListener("webglcontextrestored", this.#contextRestored);
  }

  /** A viewport where `element` is: above the canvas, focusable. Its pointer and key events are the view's. */
  addView(element: HTMLElement, options: ViewOptions): ShapeView {
    const view = new ShapeView(element, options, {
      invalidate: this.#invalidate,
      inputAt: (time) => {
        this.#inputAt ??= time;
      },
      moved: (moved) => this.#follow(moved),
      removed: (removed) => this.#forget(removed),
    });
    this.#views.add(view);
    this.#resized.observe(element);
    this.invalidate();
    return view;
  }

  /** Views that look alike from now on, as the first of them does; none for no linking. */
  link(views: readonly ShapeView[]): void {
    this.#links = views;
    if (views[0] !== undefined) this.#follow(views[0]);
  }

  /** Draws before the browser next shows the page. */
  invalidate(): void {
    if (this.#frame === 0) this.#frame = requestAnimationFrame(() => this.#draw());
  }

  /** Frees the graphics context. Models are disposed by those who made them. */
  dispose(): void {
    cancelAnimationFrame(this.#frame);
    clearTimeout(this.#stillness);
    this.#frame = -1;
    for (const view of [...this.#views]) view.remove();
    this.#resized.disconnect();
    this.#canvas.removeEventListener("webglcontextlost", this.#contextLost);
    this.#canvas.removeEventListener("webglcontextrestored", this.#contextRestored);
    this.#graphics.renderer.dispose();
    this.#graphics.renderer.forceContextLoss();
  }

  readonly #contextLost = () => this.onContext?.("lost");

  readonly #contextRestored = () => {
    this.#isSpoilt = true;
    this.invalidate();
    this.onContext?.("restored");
  };

  #draw(): void {
    if (this.#frame < 0) return;
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    clearTimeout(this.#stillness);
    if (this.#graphics.isSoftware) {
      this.#drawAt(1);
      this.#stillness = setTimeout(() => this.#refine(), STILL_AFTER_MS);
    } else this.#drawAt(Math.min(window.devicePixelRatio, MOST_PIXELS_TO_ONE));
    if (this.#inputAt !== null) {
      performance.measure("partwise:brush", { start: this.#inputAt, end: performance.now() });
      performance.clearMeasures("partwise:brush"); // who observes has it; the browser's list would grow for ever
    }
    this.#inputAt = null;
  }

  /** Not during a gesture, which would have to wait for it. */
  #refine(): void {
    if ([...this.#views].some((view) => view.isHeld))
      this.#stillness = setTimeout(() => this.#refine(), STILL_AFTER_MS);
    else this.#drawAt(STILL_PIXELS_TO_ONE);
  }

  #drawAt(pixelsToOne: number): void {
    const { renderer } = this.#graphics;
    const box = this.#canvas.getBoundingClientRect();
    const isFit =
      this.#canvas.width === Math.floor(box.width * pixelsToOne) &&
      this.#canvas.height === Math.floor(box.height * pixelsToOne);
    if (!isFit) {
      renderer.setPixelRatio(pixelsToOne);
      renderer.setSize(box.width, box.height, false);
      this.#isSpoilt = true;
    }
    // without a graphics card what was drawn stays: what did not change is left as it is
    const isAnew = this.#isSpoilt || !this.#graphics.isSoftware;
    this.#isSpoilt = false;
    if (isAnew) {
      renderer.setViewport(0, 0, box.width, box.height);
      renderer.setScissor(0, 0, box.width, box.height);
      renderer.clear();
    }
    for (const view of this.#views) view.draw(renderer, box, isAnew);
  }

  #follow(leader: ShapeView): void {
    if (!this.#links.includes(leader)) return;
    for (const view of this.#links) if (view !== leader) view.follow(leader.pose);
  }

  #forget(view: ShapeView): void {
    this.#views.delete(view);
    this.#links = this.#links.filter((linked) => linked !== view);
    this.#resized.unobserve(view.element);
    this.#isSpoilt = true;
    this.invalidate();
  }
}
