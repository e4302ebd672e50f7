/** The map on a canvas: points by the pixel, and above them what is marked, drawn when something changed. */
import { boxOf, type Camera, cameraOver, type Extent, toMap, toScreen } from "./camera";
import { type Colouring, kindsOf, paletteOf, tokenColours } from "./colours";
import type { Place } from "./lasso";
import { type MapPoints, placeOf } from "./mapPoints";
import { paintPoints } from "./paintPoints";
import { PointGrid } from "./pointGrid";

const MOST_PIXEL_RATIO = 2;

/** What is marked above the points. outline : on the map, being drawn. hovered : a point's place, or -1. */
export interface Marks {
  readonly chosen: ReadonlySet<number>;
  readonly outline: readonly Place[];
  readonly hovered: number;
}

export class MapView {
  grid: PointGrid;
  camera: Camera;
  /** Called when something else is in view. */
  onLook: () => void = () => undefined;
  private home: Camera;
  private extent: Extent = { width: 1, height: 1 };
  private ratio = 1;
  private marks: Marks = { chosen: new Set(), outline: [], hovered: -1 };
  private colouring: Colouring = "cluster";
  private kinds: Uint8Array;
  private image: ImageData | undefined;
  private frame = 0;
  private canvas: HTMLCanvasElement | undefined;
  private observer: ResizeObserver | undefined;
  private colours: { palette: Uint32Array; text: string; surface: string } | undefined;
  private readonly scheme = window.matchMedia("(prefers-color-scheme: dark)");
  private readonly schemeChoice = new MutationObserver(() => this.recolour());

  /** camera : null shows all. */
  constructor(
    public points: MapPoints,
    camera: Camera | null,
  ) {
    this.grid = new PointGrid(points);
    this.kinds = kindsOf(points, this.colouring);
    this.home = cameraOver(boxOf(points), this.extent);
    this.camera = camera ?? this.home;
  }

  /** Takes other points. What is in view stays, unless nothing would be. */
  show(points: MapPoints): void {
    if (points === this.points) return;
    const isPlacedAnew = points.x !== this.points.x;
    this.points = points;
    this.kinds = kindsOf(points, this.colouring);
    if (isPlacedAnew) {
      const wasHome = this.isHome;
      this.grid = new PointGrid(points);
      this.home = cameraOver(boxOf(points), this.extent);
      if (wasHome || this.inView().length === 0) this.camera = this.home;
      this.onLook();
    }
    this.draw();
  }

  connect(canvas: HTMLCanvasElement): void {
    this.canvas = canvas;
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(canvas);
    this.scheme.addEventListener("change", this.recolour);
    this.schemeChoice.observe(document.documentElement, { attributeFilter: ["data-scheme"] });
    this.resize();
  }

  disconnect(): void {
    cancelAnimationFrame(this.frame);
    this.observer?.disconnect();
    this.scheme.removeEventListener("change", this.recolour);
    this.schemeChoice.disconnect();
    this.canvas = undefined;
  }

  get size(): Extent {
    return this.extent;
  }

  get homeCamera(): Camera {
    return this.home;
  }

  get isHome(): boolean {
    return this.camera === this.home;
  }

  look(camera: Camera): void {
    this.camera = camera;
    this.draw();
    this.onLook();
  }

  goHome(): void {
    this.look(this.home);
  }

  mark(marks: Partial<Marks>): void {
    this.marks = { ...this.marks, ...marks };
    this.draw();
  }

  colourBy(colouring: Colouring): void {
    this.colouring = colouring;
    this.kinds = kindsOf(this.points, colouring);
    this.recolour();
  }

  /** Radius of a point in pixels of the page: the fewer there are, the larger. */
  get radius(): number {
    const zoom = Math.sqrt(this.camera.scale / this.home.scale);
    return Math.min(7, Math.max(1.2, (70 / Math.sqrt(Math.max(1, this.points.n))) * zoom));
  }

  /** Places of the points that are in view, in ascending order. */
  inView(): number[] {
    const [left, top] = toMap(this.camera, this.extent, 0, 0);
    const [right, bottom] = toMap(this.camera, this.extent, this.extent.width, this.extent.height);
    return this.grid.within({ left, right, bottom, top });
  }

  /** The point nearest to a place on the canvas, in pixels, within so many of them; -1 if there is none. */
  nearest(px: number, py: number, reach: number): number {
    return this.grid.nearest(...toMap(this.camera, this.extent, px, py), reach / this.camera.scale);
  }

  readonly draw = (): void => {
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame(() => this.drawNow());
  };

  private readonly recolour = (): void => {
    this.colours = undefined;
    this.draw();
  };

  /** Read from the page once, not for every frame: it makes the browser work out styles anew. */
  private coloursNow(host: HTMLElement) {
    const [text, surface] = tokenColours(host, ["--text", "--surface"]).map(cssOf) as [string, string];
    return { palette: paletteOf(host, this.colouring), text, surface };
  }

  private resize(): void {
    if (!this.canvas) return;
    const { clientWidth, clientHeight } = this.canvas;
    const wasHome = this.isHome;
    this.ratio = Math.min(MOST_PIXEL_RATIO, window.devicePixelRatio);
    this.extent = { width: Math.max(1, clientWidth), height: Math.max(1, clientHeight) };
    this.canvas.width = Math.round(this.extent.width * this.ratio);
    this.canvas.height = Math.round(this.extent.height * this.ratio);
    this.image = undefined;
    this.home = cameraOver(boxOf(this.points), this.extent);
    if (wasHome) this.camera = this.home;
    this.onLook();
    this.drawNow(); // a canvas is empty once it is resized, and would flicker until the next frame
  }

  private drawNow(): void {
    const context = this.canvas?.getContext("2d");
    if (!this.canvas || !context) return;
    const { width, height } = this.canvas;
    this.image ??= context.createImageData(width, height);
    const pixels = new Uint32Array(this.image.data.buffer);
    pixels.fill(0);
    const camera = { ...this.camera, scale: this.camera.scale * this.ratio };
    this.colours ??= this.coloursNow(this.canvas.parentElement ?? document.body);
    const { palette, text, surface } = this.colours;
    const look = { kind: this.kinds, palette, radius: this.radius * this.ratio };
    paintPoints(pixels, { width, height }, this.points, camera, look);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.putImageData(this.image, 0, 0);
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.drawMarks(context, text, surface);
  }

  private drawMarks(context: CanvasRenderingContext2D, text: string, surface: string): void {
    for (let place = 0; place < this.points.n; place++) {
      if (this.points.isFirst[place]) this.diamond(context, place, text, surface);
    }
    for (const id of this.marks.chosen) this.ring(context, placeOf(this.points, id), text, surface, 2);
    this.ring(context, this.marks.hovered, text, surface, 4);
    this.line(context, text);
  }

  /** A ring of two tones, to be seen on every colour. */
  private ring(
    context: CanvasRenderingContext2D,
    place: number,
    dark: string,
    light: string,
    away: number,
  ): void {
    if (place < 0) return;
    const [px, py] = this.at(place);
    const rings: [string, number][] = [
      [light, 4],
      [dark, 2],
    ];
    for (const [colour, width] of rings) {
      context.beginPath();
      context.arc(px, py, this.radius + away, 0, 2 * Math.PI);
      context.lineWidth = width;
      context.strokeStyle = colour;
      context.stroke();
    }
  }

  private diamond(context: CanvasRenderingContext2D, place: number, dark: string, light: string): void {
    const [px, py] = this.at(place);
    const reach = this.radius + 4;
    context.beginPath();
    context.moveTo(px, py - reach);
    context.lineTo(px + reach, py);
    context.lineTo(px, py + reach);
    context.lineTo(px - reach, py);
    context.closePath();
    context.lineWidth = 3.5;
    context.strokeStyle = light;
    context.stroke();
    context.lineWidth = 1.5;
    context.strokeStyle = dark;
    context.stroke();
  }

  private line(context: CanvasRenderingContext2D, colour: string): void {
    const { outline } = this.marks;
    if (outline.length < 2) return;
    context.beginPath();
    for (const [x, y] of outline) context.lineTo(...toScreen(this.camera, this.extent, x, y));
    context.closePath();
    context.setLineDash([5, 4]);
    context.lineWidth = 1.5;
    context.strokeStyle = colour;
    context.stroke();
    context.setLineDash([]);
  }

  private at(place: number): [number, number] {
    const { x, y } = this.points;
    return toScreen(this.camera, this.extent, x[place] as number, y[place] as number);
  }
}

function cssOf(colour: number): string {
  return `rgb(${colour & 255} ${(colour >> 8) & 255} ${(colour >> 16) & 255})`;
}
