/** A stroke while it is drawn: the faces under the pointer's path, also between the places that the browser reports. */
import type { GesturedView } from "./gesturedView";
import type { Hit } from "./shapeModel";

/** Pixels between picks along a drag: below the size of faces that a hand can aim at. */
const STEP = 4;

export class Strokes {
  readonly #view: GesturedView;
  #at: { x: number; y: number } | null = null;
  #last: Hit | null = null;

  constructor(view: GesturedView) {
    this.#view = view;
  }

  get isDrawing(): boolean {
    return this.#at !== null;
  }

  start(hit: Hit, event: PointerEvent): void {
    this.#at = { x: event.clientX, y: event.clientY };
    this.#last = hit;
    this.#view.tell((listener) => listener.strokeStart?.(hit, event), event.timeStamp);
  }

  move(event: PointerEvent): void {
    const places = event.getCoalescedEvents?.() ?? [];
    const hits = (places.length > 0 ? places : [event]).flatMap((place) =>
      this.#hitsTo(place.clientX, place.clientY),
    );
    if (hits.length === 0) return;
    this.#view.tell((listener) => listener.strokeMove?.(hits, event), event.timeStamp);
  }

  end(): void {
    if (this.#at === null) return;
    this.#at = null;
    this.#view.tell((listener) => listener.strokeEnd?.());
  }

  cancel(): void {
    if (this.#at === null) return;
    this.#at = null;
    this.#view.tell((listener) => listener.strokeCancel?.());
  }

  #hitsTo(x: number, y: number): Hit[] {
    if (this.#at === null) return [];
    const from = this.#at;
    const steps = Math.max(1, Math.ceil(Math.hypot(x - from.x, y - from.y) / STEP));
    const hits: Hit[] = [];
    for (let step = 1; step <= steps; step += 1) {
      const share = step / steps;
      const hit = this.#view.pick(from.x + (x - from.x) * share, from.y + (y - from.y) * share);
      if (hit === null || !this.#isFurther(hit)) continue;
      this.#last = hit;
      hits.push(hit);
    }
    this.#at = { x, y };
    return hits;
  }

  #isFurther({ face, point }: Hit): boolean {
    if (this.#last === null) return true;
    if (face === this.#last.face) return false;
    const [x, y, z] = this.#last.point;
    const distance = Math.hypot(point[0] - x, point[1] - y, point[2] - z);
    return distance >= this.#view.strokeSpacing * (this.#view.model?.mesh.diagonal ?? 0);
  }
}
