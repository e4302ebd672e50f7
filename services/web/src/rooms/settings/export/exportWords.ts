/** What an export can be, in words. */
import type { Schemas } from "../../../api/client";

export type ExportWish = Schemas["ExportParameters"];

interface Words<T extends string> {
  value: T;
  label: string;
  meaning: string;
}

export const SEGMENTATIONS: readonly Words<ExportWish["segmentation"]>[] = [
  { value: "confirmed", label: "Confirmed", meaning: "What people have made and confirmed." },
  {
    value: "refined",
    label: "Refined",
    meaning: "The newest model’s predictions, with boundaries moved to creases.",
  },
  { value: "predicted", label: "Predicted", meaning: "The newest model’s predictions as they are." },
];

export const FORMATS: readonly Words<ExportWish["format"]>[] = [
  {
    value: "seg",
    label: "SEG, a number a face",
    meaning: "A text file for each shape: one part number a line, in face order.",
  },
  {
    value: "ply",
    label: "PLY, coloured mesh",
    meaning: "The mesh with a colour and a part number for each face.",
  },
  {
    value: "glb",
    label: "GLB, a node a part",
    meaning: "The mesh cut into one node for each part, for other 3D programs.",
  },
  {
    value: "npz",
    label: "NPZ, NumPy arrays",
    meaning: "Vertices, faces and labels as NumPy arrays, for Python.",
  },
  {
    value: "shapenetpart",
    label: "ShapeNetPart points",
    meaning: "Points on the surface with normals and part numbers, as text.",
  },
  {
    value: "coco",
    label: "COCO-style JSON",
    meaning: "One JSON file for all shapes, with parts as categories.",
  },
];

export const MESHES: readonly Words<ExportWish["on"]>[] = [
  { value: "working", label: "The mesh that people label", meaning: "Exactly what was labelled." },
  {
    value: "original",
    label: "The file’s own faces",
    meaning: "Labels are mapped back to the faces of the file that was added.",
  },
];

export function wordsOf(words: readonly Words<string>[], value: unknown): string {
  return words.find((each) => each.value === value)?.label ?? String(value);
}

export function meaningOf(words: readonly Words<string>[], value: string): string {
  return words.find((each) => each.value === value)?.meaning ?? "";
}
