"""The file of one shape's labels, in each format, and the one file of all shapes that COCO is."""

import numpy as np
from jaxtyping import Int

from partwise import __version__
from partwise.exchange.coco import CocoShape, coco_shape
from partwise.exchange.glb_parts import write_glb_parts
from partwise.exchange.label_npz import write_npz
from partwise.exchange.labelled_mesh import DescribedMesh, LabelledMesh, Provenance
from partwise.exchange.labelled_points import sample_labelled_points, write_points
from partwise.exchange.parts import PartEntry, PartTable
from partwise.exchange.ply_labels import write_ply_labels
from partwise.exchange.seg import write_seg
from partwise.labels.schema import PartSchema
from partwise.unlabelled import NO_CLASS, NO_PART_ID
from partwise.workspace.choices import ExportFormat, PointSampling
from partwise.workspace.placed_labels import PlacedLabels
from partwise.workspace.shapes import load_mesh
from partwise.workspace.workspace import Workspace

COCO_FILE = "coco.json"
ENDINGS = {
    ExportFormat.SEG: ".seg",
    ExportFormat.PLY: ".ply",
    ExportFormat.GLB: ".glb",
    ExportFormat.NPZ: ".npz",
    ExportFormat.SHAPENETPART: ".txt",
}
"""Of the formats that have a file for each shape."""


def part_table(schema: PartSchema) -> PartTable:
    """The schema as files carry it."""
    entries = (PartEntry(part.id, part.name, part.colour.lower(), part.gloss, part.parent_id) for part in schema.parts)
    return PartTable(schema.version, tuple(entries))


def file_labels(placed: PlacedLabels) -> Int[np.ndarray, " m"]:
    """Labels as files have them, (m,) int64: part ids, −1 where unlabelled."""
    labels = placed.labels.astype(np.int64)
    labels[labels == NO_PART_ID] = NO_CLASS
    return labels


def write_shape(
    workspace: Workspace,
    placed: PlacedLabels,
    parts: PartTable,
    file_format: ExportFormat,
    path: str,
    sampling: PointSampling,
) -> None:
    """Writes the file of one shape in one of `ENDINGS`. Points depend on seed and source key, not on other shapes.

    Raises
    ------
    PartwiseError : the labels cannot be written in this format.
    StoreError : the mesh cannot be read, or the file not written.
    """
    if file_format is ExportFormat.SEG:
        write_seg(path, file_labels(placed))
        return
    described = _described(workspace, placed, parts)
    if file_format is ExportFormat.PLY:
        write_ply_labels(path, described.labelled, parts.colours())
    elif file_format is ExportFormat.GLB:
        write_glb_parts(path, described)
    elif file_format is ExportFormat.NPZ:
        write_npz(path, described)
    else:
        rng = np.random.default_rng(
            np.random.SeedSequence(sampling.seed, spawn_key=tuple(placed.shape.source_key.encode()))
        )
        points = sample_labelled_points(
            described.labelled, sampling.n_points, rng, omit_unlabelled=sampling.omit_unlabelled
        )
        write_points(path, points)


def coco_of(workspace: Workspace, placed: PlacedLabels, parts: PartTable) -> CocoShape:
    """What COCO's file says of one shape."""
    return coco_shape(placed.shape.source_key, _described(workspace, placed, parts))


def _described(workspace: Workspace, placed: PlacedLabels, parts: PartTable) -> DescribedMesh:
    shape = placed.shape
    provenance = Provenance(shape.source_key, shape.source_hash, placed.kind, placed.model_version, __version__)
    return DescribedMesh(LabelledMesh(load_mesh(workspace, placed.mesh), file_labels(placed)), parts, provenance)
