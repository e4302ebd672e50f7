/** A shape cut into patches, and which faces each has. */
export class PatchMap {
  readonly nPatches: number;
  private readonly first: Uint32Array;
  private readonly faces: Uint32Array;

  /** patchOf : (m) the patch of each face, numbered from 0. */
  constructor(readonly patchOf: Uint32Array) {
    this.nPatches = patchOf.reduce((most, patch) => Math.max(most, patch + 1), 0);
    this.first = new Uint32Array(this.nPatches + 1);
    for (const patch of patchOf) this.first[patch + 1] = (this.first[patch + 1] as number) + 1;
    for (let patch = 0; patch < this.nPatches; patch++) {
      this.first[patch + 1] = (this.first[patch + 1] as number) + (this.first[patch] as number);
    }
    const next = this.first.slice();
    this.faces = new Uint32Array(patchOf.length);
    patchOf.forEach((patch, face) => {
      const place = next[patch] as number;
      this.faces[place] = face;
      next[patch] = place + 1;
    });
  }

  /** Faces of a patch, ascending. */
  facesOf(patch: number): Uint32Array {
    return this.faces.subarray(this.first[patch], this.first[patch + 1]);
  }

  /** The faces of the patch that a face is in. */
  around(face: number): Uint32Array {
    return this.facesOf(this.patchOf[face] as number);
  }
}
