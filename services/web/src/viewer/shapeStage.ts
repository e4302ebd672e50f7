/**
 * One canvas and one graphics context for all viewports: browsers allow few contexts, and shapes shown twice are held
 * once. Draws only when something changed.
 */
import { WebGLRenderer } from "three";
import { ShapeView, type ViewOptions } from "./shapeView";

const MOST_PIXELS_TO_ONE = 2;

/** This browser shows no WebGL 2. The message is for people. */
export class NoWebGlError extends Error {
  override readonly name = "NoWebGlError";
}

export class ShapeStage {
  /** Called when the browser takes the graphics context away, and when it is back and all is drawn anew. */
  onContext: ((state: "lost" | "restored") => void) | null = null;
  readonly #canvas: HTMLCanvasElement;
  readonly #renderer: WebGLRenderer;
  readonly #views = new Set<ShapeView>();
  readonly #resized: ResizeObserver;
  readonly #invalidate = () => this.invalidate();
  #links: readonly ShapeView[] = [];
  #frame = 0;
  #inputAt: number | null = null;

  /** canvas : behind the elements of the views, at least as large as all of them. Throws NoWebGlError. */
  constructor(canvas: HTMLCanvasElement) {
    this.#canvas = canvas;
    this.#renderer = newRenderer(canvas);
    this.#renderer.autoClear = false;
    this.#renderer.setClearAlpha(0);
    this.#renderer.setScissorTest(true);
    this.#resized = new ResizeObserver(() => this.#draw()); // at once: a resized canvas is blank
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
    this.#frame = -1;
    for (const view of [...this.#views]) view.remove();
    this.#resized.disconnect();
    this.#canvas.removeEventListener("webglcontextlost", this.#contextLost);
    this.#canvas.removeEventListener("webglcontextrestored", this.#contextRestored);
    this.#renderer.dispose();
    this.#renderer.forceContextLoss();
  }

  readonly #contextLost = () => this.onContext?.("lost");

  readonly #contextRestored = () => {
    this.invalidate();
    this.onContext?.("restored");
  };

  #draw(): void {
    if (this.#frame < 0) return;
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    const box = this.#fitCanvas();
    for (const view of this.#views) view.draw(this.#renderer, box);
    if (this.#inputAt !== null) {
      performance.measure("partwise:brush", { start: this.#inputAt, end: performance.now() });
      performance.clearMeasures("partwise:brush"); // who observes has it; the browser's list would grow for ever
    }
    this.#inputAt = null;
  }

  #fitCanvas(): DOMRect {
    const box = this.#canvas.getBoundingClientRect();
    const ratio = Math.min(window.devicePixelRatio, MOST_PIXELS_TO_ONE);
    const isFit =
      this.#canvas.width === Math.floor(box.width * ratio) &&
      this.#canvas.height === Math.floor(box.height * ratio);
    if (!isFit || this.#renderer.getPixelRatio() !== ratio) {
      this.#renderer.setPixelRatio(ratio);
      this.#renderer.setSize(box.width, box.height, false);
    }
    this.#renderer.setViewport(0, 0, box.width, box.height);
    this.#renderer.setScissor(0, 0, box.width, box.height);
    this.#renderer.clear();
    return box;
  }

  #follow(leader: ShapeView): void {
    if (!this.#links.includes(leader)) return;
    for (const view of this.#links) if (view !== leader) view.follow(leader.pose);
  }

  #forget(view: ShapeView): void {
    this.#views.delete(view);
    this.#links = this.#links.filter((linked) => linked !== view);
    this.#resized.unobserve(view.element);
    this.invalidate();
  }
}

function newRenderer(canvas: HTMLCanvasElement): WebGLRenderer {
  try {
    return new WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: "high-performance" });
  } catch {
    throw new NoWebGlError(
      "This browser does not show 3D. Turn hardware acceleration on, or use another browser.",
    );
  }
}
