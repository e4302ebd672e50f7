/** A mesh with all that viewing and painting need of it. */
import { SurfaceMesh } from "../geometry/surfaceMesh";
import type { PreparedSurface } from "./surfacePreparation";

export interface PreparedMesh {
  readonly mesh: SurfaceMesh;
  readonly surface: Pick<PreparedSurface, "positions" | "spheres" | "outline" | "normals" | "isSolid">;
}

/** The mesh of a surface that was prepared elsewhere; it keeps its measures and adjacency, too. */
export function meshOf(surface: PreparedSurface, hash: string): PreparedMesh {
  const mesh = new SurfaceMesh(surface.vertices, surface.faces, hash);
  mesh.adopt(surface.measures, surface.graph);
  return { mesh, surface };
}
