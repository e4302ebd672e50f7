/** A shape on the graphics card: its surface and what is shown on it, for any number of views. */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  FrontSide,
  GLSL3,
  Mesh,
  type Ray,
  RGBAFormat,
  Scene,
  ShaderMaterial,
  Sphere,
  UnsignedByteType,
  Vector3,
} from "three";
import type { SurfaceMesh } from "../geometry/surfaceMesh";
import { type Palette, rgbOf } from "./colours";
import { FaceStates } from "./faceStates";
import type { PreparedMesh } from "./preparedMesh";
import type { MeshBVH } from "./searchTree";
import { FRAGMENT_SHADER, STATES_WIDTH, VERTEX_SHADER } from "./shapeShaders";

/** Where a pointer meets a surface. point : in the mesh's coordinates. */
export interface Hit {
  readonly face: number;
  readonly point: readonly [number, number, number];
}

export interface BrushCircle {
  readonly point: readonly [number, number, number];
  /** A share of the diagonal, as in strokes. */
  readonly radius: number;
}

export interface ModelOptions {
  /** `performance.now()` when the person asked for the shape: from then the first paint is measured. */
  readonly since?: number;
}

export class ShapeModel {
  readonly mesh: SurfaceMesh;
  /** (3k) What a view has to frame, in the mesh's coordinates. */
  readonly outline: Float32Array;
  readonly scene = new Scene();
  /** Called whenever something must be drawn anew; the views that show the shape listen. */
  readonly changed = new Set<() => void>();
  #tree: MeshBVH | null = null;
  /** Ends once drawing the shape was first asked for. */
  readonly drawn: Promise<void>;
  #tellDrawn: () => void = () => {};
  #since: number | null;
  readonly #geometry: BufferGeometry;
  readonly #texture: DataTexture;
  readonly #states: FaceStates;
  readonly #prepared: PreparedMesh;
  readonly #side: typeof FrontSide | typeof DoubleSide;
  readonly #uniforms: Uniforms;
  readonly #material: ShaderMaterial;

  constructor(prepared: PreparedMesh, { since }: ModelOptions = {}) {
    const { mesh, surface } = prepared;
    this.#prepared = prepared;
    this.mesh = mesh;
    this.outline = surface.outline;
    this.#side = surface.isSolid ? FrontSide : DoubleSide;
    this.drawn = new Promise((resolve) => {
      this.#tellDrawn = resolve;
    });
    this.#since = since ?? null;
    const height = Math.ceil(this.mesh.nFaces / STATES_WIDTH);
    this.#states = new FaceStates(this.mesh.graph, 4 * STATES_WIDTH * height, () => this.#upload());
    this.#texture = new DataTexture(this.#states.bytes, STATES_WIDTH, height, RGBAFormat, UnsignedByteType);
    this.#texture.needsUpdate = true;
    this.#uniforms = newUniforms(this.#texture);
    this.#material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX_SHADER,
      fragmentShader: FRAGMENT_SHADER,
      side: this.#side,
      uniforms: this.#uniforms,
    });
    this.#geometry = shownGeometry(mesh, surface);
    const shown = new Mesh(this.#geometry, this.#material);
    shown.matrixAutoUpdate = false;
    this.scene.add(shown);
    this.scene.matrixWorldAutoUpdate = false;
  }

  /** From now on, faces are found under a pointer. */
  pickWith(tree: MeshBVH): void {
    this.#tree = tree;
  }

  /** The same surface once more, to show something else on it. To be disposed by whoever asked. */
  alike(): ShapeModel {
    const other = new ShapeModel(this.#prepared);
    if (this.#tree !== null) other.pickWith(this.#tree);
    return other;
  }

  setPalette(palette: Palette): void {
    this.#states.setPalette(palette);
  }

  /** Labels to show, (m) part ids. The array is kept: call `recolour` when some of it changed. */
  setLabels(labels: Uint16Array): void {
    this.#states.setLabels(labels);
  }

  /** Shows the labels of these faces, ascending, anew: those of an editor's change. */
  recolour(faces: Uint32Array): void {
    this.#states.recolour(faces);
  }

  /** Faces, ascending, that the tool in hand would take, tinted with `colour`; null for none. */
  setPreview(faces: Uint32Array | null, colour?: string): void {
    if (colour !== undefined) this.#uniforms.uHighlight.value.setRGB(...unitRgb(colour));
    this.#states.highlight(faces);
  }

  /** Further faces of the preview, ascending: what a drag added. */
  addPreview(faces: Uint32Array): void {
    this.#states.highlightMore(faces);
  }

  /** The patch of each face, shown as tints on unlabelled faces and fine borders; null for none. */
  setPatches(patches: Uint16Array | Uint32Array | null): void {
    this.#states.setPatches(patches);
  }

  /** A value from 0 to 1 for each face shown instead of the parts, as uncertainty; null for the parts. */
  setHeat(values: Float32Array | null): void {
    this.#states.setHeat(values);
  }

  /** The brush as a circle on the surface; null for none. */
  setBrush(brush: BrushCircle | null): void {
    const { uBrushPoint, uBrushRadius } = this.#uniforms;
    if (brush === null && uBrushRadius.value === 0) return;
    uBrushPoint.value.set(...(brush?.point ?? this.mesh.centre));
    uBrushRadius.value = (brush?.radius ?? 0) * this.mesh.diagonal;
    this.#draw();
  }

  /** Whether the edges of faces are drawn. */
  setWireframe(isOn: boolean): void {
    this.#uniforms.uWireframe.value = isOn;
    this.#draw();
  }

  /** The first face along a ray in the mesh's coordinates, of those that are drawn; null before `pickWith`, too. */
  hit(ray: Ray): Hit | null {
    const found = this.#tree?.raycastFirst(ray, this.#side);
    if (found?.faceIndex === undefined || found.faceIndex === null) return null;
    return { face: found.faceIndex, point: found.point.toArray() };
  }

  /** Readies the shape for being drawn by one view. up : as the camera sees it. */
  aim(up: Vector3, pixelRatio: number): void {
    this.#uniforms.uUp.value.copy(up);
    this.#uniforms.uPixel.value = pixelRatio;
    this.#material.uniformsNeedUpdate = true;
  }

  /** After the shape was drawn: the first time, says how long the person waited for it. */
  wasDrawn(): void {
    this.#tellDrawn();
    if (this.#since === null) return;
    performance.measure("partwise:first-paint", { start: this.#since, end: performance.now() });
    this.#since = null;
  }

  /** Frees what the graphics card holds. */
  dispose(): void {
    this.changed.clear();
    this.#geometry.dispose();
    this.#texture.dispose();
    this.#material.dispose();
  }

  /** The whole texture, once a frame whatever changed: 200 kB at 50,000 faces. */
  #upload(): void {
    this.#texture.needsUpdate = true;
    this.#draw();
  }

  #draw(): void {
    for (const draw of this.changed) draw();
  }
}

type Uniforms = ReturnType<typeof newUniforms>;

function newUniforms(faces: DataTexture) {
  return {
    uFaces: { value: faces },
    uUp: { value: new Vector3(0, 1, 0) },
    uPixel: { value: 1 },
    uHighlight: { value: new Color() },
    uWireframe: { value: false },
    uBrushPoint: { value: new Vector3() },
    uBrushRadius: { value: 0 },
  };
}

/** Three vertices to a face, in face order, so that a vertex knows its face and a face has colours of its own. */
function shownGeometry(mesh: SurfaceMesh, { positions, normals }: PreparedMesh["surface"]): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new BufferAttribute(normals, 4, true));
  geometry.boundingSphere = new Sphere(new Vector3(...mesh.centre), mesh.diagonal / 2);
  return geometry;
}

function unitRgb(colour: string): [number, number, number] {
  const [red, green, blue] = rgbOf(colour);
  return [red / 255, green / 255, blue / 255];
}
