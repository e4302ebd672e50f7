/**
 * What is shown on each face, as bytes that a shader reads: its colour, which of its edges are borders, and whether it is
 * highlighted. Changing some faces costs what they cost.
 */
import type { FaceGraph } from "../geometry/faceGraph";
import { heatColour, type Palette, patchTint, type Rgb, rgbOf } from "./colours";

/** Bits of a face's fourth byte; edge k is from corner k to k + 1. The shader has the same. */
export const LABEL_BORDER = 1; // << k
export const PATCH_BORDER = 8; // << k
export const HIGHLIGHTED = 64;

type Ids = Uint16Array | Uint32Array;

export class FaceStates {
  /** (4m) red, green, blue, bits. */
  readonly bytes: Uint8Array;
  readonly #graph: FaceGraph;
  readonly #touched: () => void;
  readonly #tints = new Map<number, Rgb>();
  #labels: Uint16Array;
  #patches: Ids | null = null;
  #heat: Float32Array | null = null;
  #highlighted: Uint32Array[] = [];
  #unlabelled: Rgb = [180, 185, 193];
  #colours = new Map<number, Rgb>();

  /** nBytes : room for all faces, or more. touched : called when bytes changed. */
  constructor(graph: FaceGraph, nBytes: number, touched: () => void) {
    this.#graph = graph;
    this.bytes = new Uint8Array(nBytes);
    this.#labels = new Uint16Array(graph.nFaces);
    this.#touched = touched;
  }

  setPalette({ unlabelled, colours }: Palette): void {
    this.#unlabelled = rgbOf(unlabelled);
    this.#colours = new Map([...colours].map(([part, colour]) => [part, rgbOf(colour)]));
    this.#tints.clear();
    this.#recolourAll();
  }

  /** The array is kept and read again by `recolour`. */
  setLabels(labels: Uint16Array): void {
    this.#labels = labels;
    this.#recolourAll();
    this.#markAllBorders(labels, LABEL_BORDER);
  }

  setPatches(patches: Ids | null): void {
    this.#patches = patches;
    this.#recolourAll();
    this.#markAllBorders(patches, PATCH_BORDER);
  }

  /** Values from 0 to 1 shown instead of parts; null for parts. */
  setHeat(values: Float32Array | null): void {
    this.#heat = values;
    this.#recolourAll();
  }

  /** After the labels of these faces changed. */
  recolour(faces: Uint32Array): void {
    if (faces.length === 0) return;
    for (const face of faces) this.#paint(face);
    this.#markBorders(this.#withNeighbours(faces), this.#labels, LABEL_BORDER);
  }

  /** These faces and no others are highlighted. */
  highlight(faces: Uint32Array | null): void {
    for (const old of this.#highlighted) for (const face of old) this.#setBits(face, HIGHLIGHTED, 0);
    this.#highlighted = [];
    this.highlightMore(faces ?? new Uint32Array(0));
  }

  highlightMore(faces: Uint32Array): void {
    for (const face of faces) this.#setBits(face, HIGHLIGHTED, HIGHLIGHTED);
    this.#highlighted.push(faces);
    this.#touched();
  }

  #recolourAll(): void {
    for (let face = 0; face < this.#graph.nFaces; face += 1) this.#paint(face);
    this.#touched();
  }

  #paint(face: number): void {
    const colour = this.#colourOf(face);
    this.bytes[4 * face] = colour[0];
    this.bytes[4 * face + 1] = colour[1];
    this.bytes[4 * face + 2] = colour[2];
  }

  #colourOf(face: number): Rgb {
    if (this.#heat !== null) return heatColour(this.#heat[face] as number);
    const label = this.#labels[face] as number;
    if (label !== 0) return this.#colours.get(label) ?? this.#unlabelled;
    return this.#patches === null ? this.#unlabelled : this.#tintOf(this.#patches[face] as number);
  }

  #tintOf(patch: number): Rgb {
    const tint = this.#tints.get(patch) ?? patchTint(patch, this.#unlabelled);
    this.#tints.set(patch, tint);
    return tint;
  }

  #markAllBorders(ids: Ids | null, bit: number): void {
    const { nFaces } = this.#graph;
    if (ids !== null) this.#markBorders(ids.keys(), ids, bit);
    else for (let face = 0; face < nFaces; face += 1) this.#setBits(face, bit * 7, 0);
    this.#touched();
  }

  #markBorders(faces: Iterable<number>, ids: Ids, bit: number): void {
    const mixedFans = new Map<number, boolean>();
    for (const face of faces) {
      let bits = 0;
      for (let side = 0; side < 3; side += 1) {
        if (this.#isBorder(face, 3 * face + side, ids, mixedFans)) bits |= bit << side;
      }
      this.#setBits(face, bit * 7, bits);
    }
    this.#touched();
  }

  #isBorder(face: number, edge: number, ids: Ids, mixedFans: Map<number, boolean>): boolean {
    const across = this.#graph.opposite[edge] as number;
    if (across >= 0) return ids[across] !== ids[face];
    const fan = this.#graph.fans[edge] as number;
    if (fan < 0) return false;
    const isMixed = mixedFans.get(fan) ?? this.#fan(fan).some((other) => ids[other] !== ids[face]);
    mixedFans.set(fan, isMixed);
    return isMixed;
  }

  #withNeighbours(faces: Uint32Array): Iterable<number> {
    const all = new Set(faces);
    const fans = new Set<number>();
    for (const face of faces) {
      for (let edge = 3 * face; edge < 3 * face + 3; edge += 1) {
        const across = this.#graph.opposite[edge] as number;
        if (across >= 0) all.add(across);
        else fans.add(this.#graph.fans[edge] as number);
      }
    }
    fans.delete(-1);
    for (const fan of fans) for (const face of this.#fan(fan)) all.add(face);
    return all;
  }

  #fan(fan: number): Uint32Array {
    const { fanStart, fanFaces } = this.#graph;
    return fanFaces.subarray(fanStart[fan], fanStart[fan + 1]);
  }

  #setBits(face: number, mask: number, bits: number): void {
    this.bytes[4 * face + 3] = ((this.bytes[4 * face + 3] as number) & ~mask) | bits;
  }
}
