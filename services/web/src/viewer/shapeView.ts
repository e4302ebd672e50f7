/** One viewport: a camera on a shape, moved by pointer and keys, and the gestures of the tool in hand. */
import { Box3, Matrix4, PerspectiveCamera, type Quaternion, Ray, Vector3, type WebGLRenderer } from "three";
import type { GesturedView, ViewListener } from "./gesturedView";
import { NavigationKeys } from "./navigationKeys";
import { PointerGestures } from "./pointerGestures";
import {
  FIELD_OF_VIEW,
  framed,
  moved,
  type NamedView,
  namedOrientation,
  type Pose,
  turned,
  type UpAxis,
  uprightRotation,
  zoomed,
} from "./pose";
import type { Hit, ShapeModel } from "./shapeModel";
import { frustumOf, partAround } from "./viewPart";

export interface ViewOptions {
  readonly up: UpAxis;
}

/** What a view tells its stage. */
export interface StageOfView {
  invalidate(): void;
  inputAt(time: number): void;
  moved(view: ShapeView): void;
  removed(view: ShapeView): void;
}

export class ShapeView implements GesturedView {
  readonly element: HTMLElement;
  tool: GesturedView["tool"] = "navigate";
  strokeSpacing = 0;
  readonly #stage: StageOfView;
  readonly #upright: Quaternion;
  readonly #camera = new PerspectiveCamera((FIELD_OF_VIEW * 180) / Math.PI);
  readonly #listeners = new Set<ViewListener>();
  readonly #gestures: PointerGestures;
  readonly #keys: NavigationKeys;
  readonly #redraw = (where: Box3 | null) => {
    if (where === null) this.#isAllStale = true;
    else this.#stale.union(where);
    this.#stage.invalidate();
  };
  /** What must be drawn anew: all, or what is in a box of the mesh's coordinates. */
  #isAllStale = true;
  readonly #stale = new Box3();
  #model: ShapeModel | null = null;
  #framed: Pose | null = null;
  #pose: Pose = { orientation: namedOrientation("threeQuarter"), offset: new Vector3(), distance: 2.4 };

  constructor(element: HTMLElement, { up }: ViewOptions, stage: StageOfView) {
    this.element = element;
    this.#stage = stage;
    this.#upright = uprightRotation(up);
    this.#gestures = new PointerGestures(this);
    this.#keys = new NavigationKeys(this);
  }

  get model(): ShapeModel | null {
    return this.#model;
  }

  /** A gesture is under way. */
  get isHeld(): boolean {
    return this.#gestures.isPressed;
  }

  get pose(): Pose {
    return this.#pose;
  }

  set pose(pose: Pose) {
    this.follow(pose);
    this.#stage.moved(this);
  }

  /** Takes a pose without leading others by it. */
  follow(pose: Pose): void {
    this.#pose = pose;
    this.#redraw(null);
    this.tell((listener) => listener.cameraChange?.(pose));
  }

  /** Shows a shape, or none. Another shape than before is framed, unless `keepsPose`; a drag on the one before is given up. */
  show(model: ShapeModel | null, { keepsPose = false } = {}): void {
    if (model === this.#model) return;
    this.#gestures.giveUpStroke();
    this.#model?.changed.delete(this.#redraw);
    model?.changed.add(this.#redraw);
    this.#model = model;
    if (model !== null && !keepsPose) this.frame();
    this.#redraw(null);
  }

  /** The whole shape closely in view, from where the camera looks now or as named. */
  frame(name?: NamedView): void {
    if (this.#model === null) return;
    const orientation = name === undefined ? this.#pose.orientation : namedOrientation(name);
    this.#framed = framed(orientation, this.#model.outline, this.#place(this.#model), this.#aspect());
    this.pose = this.#framed;
  }

  /** After the element got another size: a shape that filled its view does so again, one that was moved stays. */
  fit(): void {
    if (this.#pose === this.#framed) this.frame();
  }

  turn(right: number, down: number): void {
    this.pose = turned(this.#pose, right, down);
  }

  move(right: number, up: number): void {
    this.pose = moved(this.#pose, right, up);
  }

  zoom(factor: number, clientX?: number, clientY?: number): void {
    const box = this.element.getBoundingClientRect();
    const right = clientX === undefined ? 0 : (clientX - box.left - box.width / 2) / box.height;
    const up = clientY === undefined ? 0 : -(clientY - box.top - box.height / 2) / box.height;
    this.pose = zoomed(this.#pose, factor, right, up);
  }

  pick(clientX: number, clientY: number): Hit | null {
    const box = this.element.getBoundingClientRect();
    const x = ((clientX - box.left) / box.width) * 2 - 1;
    const y = 1 - ((clientY - box.top) / box.height) * 2;
    if (this.#model === null || !(Math.abs(x) <= 1 && Math.abs(y) <= 1)) return null;
    this.#aimCamera(this.#model, box.width / box.height);
    const point = new Vector3(x, y, 0.5).unproject(this.#camera);
    return this.#model.hit(
      new Ray(this.#camera.position.clone(), point.sub(this.#camera.position).normalize()),
    );
  }

  /** What is in the middle of the view: what keys act on. */
  centreHit(): Hit | null {
    const box = this.element.getBoundingClientRect();
    return this.pick(box.left + box.width / 2, box.top + box.height / 2);
  }

  /** Tells `listener` of gestures until the returned function is called. */
  listen(listener: ViewListener): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  tell(what: (listener: ViewListener) => void, inputAt?: number): void {
    if (inputAt !== undefined) this.#stage.inputAt(inputAt);
    for (const listener of this.#listeners) what(listener);
  }

  /**
   * Draws what changed into this view's part of the canvas, or all of it. canvas : its rectangle on the page. isAnew :
   * nothing is drawn there.
   */
  draw(renderer: WebGLRenderer, canvas: DOMRect, isAnew: boolean): void {
    const box = this.element.getBoundingClientRect();
    if (box.width < 1 || box.height < 1) return;
    const model = this.#model;
    if (model !== null) this.#aimCamera(model, box.width / box.height);
    const whole = { left: 0, bottom: 0, width: box.width, height: box.height };
    const part = isAnew || this.#isAllStale ? whole : partAround(this.#stale, this.#camera, whole);
    this.#isAllStale = false;
    this.#stale.makeEmpty();
    if (part === null) return;
    const [left, bottom] = [box.left - canvas.left, canvas.bottom - box.bottom];
    renderer.setViewport(left, bottom, box.width, box.height);
    renderer.setScissor(left + part.left, bottom + part.bottom, part.width, part.height);
    if (!isAnew) renderer.clear();
    if (model === null) return;
    const up = new Vector3(0, 1, 0).applyQuaternion(this.#pose.orientation.clone().invert());
    model.aim(up, renderer.getPixelRatio(), frustumOf(this.#camera, part, whole));
    renderer.render(model.scene, this.#camera);
    model.wasDrawn();
  }

  /** Ends the view. The element stays. */
  remove(): void {
    this.show(null);
    this.#gestures.remove();
    this.#keys.remove();
    this.#listeners.clear();
    this.#stage.removed(this);
  }

  #aspect(): number {
    const { width, height } = this.element.getBoundingClientRect();
    return width > 0 && height > 0 ? width / height : 1;
  }

  #aimCamera({ mesh }: ShapeModel, aspect: number): void {
    const { orientation, offset, distance } = this.#pose;
    const camera = this.#camera;
    camera.aspect = aspect;
    camera.quaternion.copy(this.#upright).multiply(orientation);
    const fromCentre = new Vector3(0, 0, distance).applyQuaternion(orientation).add(offset);
    camera.near = Math.max(fromCentre.length() - 0.6, distance * 0.02) * mesh.diagonal;
    camera.far = (fromCentre.length() + 0.6) * mesh.diagonal;
    camera.position.copy(fromCentre).applyQuaternion(this.#upright).multiplyScalar(mesh.diagonal);
    camera.position.add(new Vector3(...mesh.centre));
    camera.updateMatrixWorld();
    camera.updateProjectionMatrix();
  }

  /** From a mesh's coordinates to right, up, front, in diagonals from its middle. */
  #place({ mesh }: ShapeModel): Matrix4 {
    const [x, y, z] = mesh.centre;
    const back = new Matrix4().makeRotationFromQuaternion(this.#upright.clone().invert());
    return back
      .scale(new Vector3().setScalar(1 / mesh.diagonal))
      .multiply(new Matrix4().makeTranslation(-x, -y, -z));
  }
}
