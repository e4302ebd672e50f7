/** A shape on the graphics card: its surface and what is shown on it, for any number of views. */
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  FrontSide,
  type Frustum,
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
import { CHUNK_FACES } from "./surfacePreparation";

const NONE = new Uint32Array(0);

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
  /** Called whenever something must be drawn anew, all of it or what is in a box; the views that show the shape listen. */
  readonly changed = new Set<(where: Box3 | null) => void>();
  #tree: MeshBVH | null = null;
  #brushBox = new Box3();
  #previewBox = new Box3();
  /** Ends once drawing the shape was first asked for. */
  readonly drawn: Promise<void>;
  #tellDrawn: () => void = () => {};
  #since: number | null;
  readonly #geometry: BufferGeometry;
  readonly #spheres: Float32Array;
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
    this.#states = new FaceStates(this.mesh.graph, 4 * STATES_WIDTH * height, () => {
      this.#texture.needsUpdate = true; // all of it, once a frame whatever changed: 200 kB at 50,000 faces
    });
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
    this.#spheres = surface.spheres;
    const shown = new Mesh(this.#geometry, [this.#material]); // as many groups as `aim` makes
    shown.matrixAutoUpdate = false;
    shown.frustumCulled = false;
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
    this.#draw(null);
  }

  /** Labels to show, (m) part ids. The array is kept: call `recolour` when some of it changed. */
  setLabels(labels: Uint16Array): void {
    this.#states.setLabels(labels);
    this.#draw(null);
  }

  /** Shows the labels of these faces, ascending, anew: those of an editor's change. */
  recolour(faces: Uint32Array): void {
    this.#states.recolour(faces);
    if (faces.length > 0) this.#draw(null);
  }

  /** Faces, ascending, that the tool in hand would take, tinted with `colour`; null for none. */
  setPreview(faces: Uint32Array | null, colour?: string): void {
    if (colour !== undefined) this.#uniforms.uHighlight.value.setRGB(...unitRgb(colour));
    this.#states.highlight(faces);
    const before = this.#previewBox;
    this.#previewBox = this.#boxOf(faces ?? NONE);
    this.#draw(before.union(this.#previewBox));
  }

  /** Further faces of the preview, ascending: what a drag added. */
  addPreview(faces: Uint32Array): void {
    this.#states.highlightMore(faces);
    const added = this.#boxOf(faces);
    this.#previewBox.union(added);
    this.#draw(added);
  }

  /** The patch of each face, shown as tints on unlabelled faces and fine borders; null for none. */
  setPatches(patches: Uint16Array | Uint32Array | null): void {
    this.#states.setPatches(patches);
    this.#draw(null);
  }

  /** A value from 0 to 1 for each face shown instead of the parts, as uncertainty; null for the parts. */
  setHeat(values: Float32Array | null): void {
    this.#states.setHeat(values);
    this.#draw(null);
  }

  /** The brush as a circle on the surface; null for none. */
  setBrush(brush: BrushCircle | null): void {
    const { uBrushPoint, uBrushRadius } = this.#uniforms;
    const radius = (brush?.radius ?? 0) * this.mesh.diagonal;
    uBrushPoint.value.set(...(brush?.point ?? this.mesh.centre));
    uBrushRadius.value = radius;
    const before = this.#brushBox;
    this.#brushBox = new Box3();
    if (brush !== null) this.#brushBox.expandByPoint(uBrushPoint.value).expandByScalar(radius);
    this.#draw(before.union(this.#brushBox));
  }

  /** Whether the edges of faces are drawn. */
  setWireframe(isOn: boolean): void {
    this.#uniforms.uWireframe.value = isOn;
    this.#draw(null);
  }

  /** The first face along a ray in the mesh's coordinates, of those that are drawn; null before `pickWith`, too. */
  hit(ray: Ray): Hit | null {
    const found = this.#tree?.raycastFirst(ray, this.#side);
    if (found?.faceIndex === undefined || found.faceIndex === null) return null;
    return { face: found.faceIndex, point: found.point.toArray() };
  }

  /** Readies the shape for being drawn by one view. up : as the camera sees it. seen : what of it is to be drawn. */
  aim(up: Vector3, pixelRatio: number, seen: Frustum): void {
    this.#geometry.groups = this.#groupsIn(seen);
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

  /** Runs of chunks that may be seen. */
  #groupsIn(seen: Frustum): { start: number; count: number; materialIndex: number }[] {
    const runs: { start: number; count: number; materialIndex: number }[] = [];
    const sphere = new Sphere();
    const step = 3 * CHUNK_FACES;
    for (let chunk = 0; chunk < this.#spheres.length / 4; chunk += 1) {
      const [x, y, z, radius] = this.#spheres.subarray(4 * chunk, 4 * chunk + 4) as unknown as Four;
      sphere.center.set(x, y, z);
      sphere.radius = radius;
      if (!seen.intersectsSphere(sphere)) continue;
      const last = runs.at(-1);
      if (last !== undefined && last.start + last.count === step * chunk) last.count += step;
      else runs.push({ start: step * chunk, count: step, materialIndex: 0 });
    }
    return runs;
  }

  #boxOf(faces: Uint32Array): Box3 {
    const { vertices, faces: corners } = this.mesh;
    const box = new Box3();
    const point = new Vector3();
    for (const face of faces) {
      for (let corner = 3 * face; corner < 3 * face + 3; corner += 1) {
        box.expandByPoint(point.fromArray(vertices, 3 * (corners[corner] as number)));
      }
    }
    return box;
  }

  #draw(where: Box3 | null): void {
    if (where?.isEmpty()) return;
    for (const draw of this.changed) draw(where);
  }
}

type Four = [number, number, number, number];
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
