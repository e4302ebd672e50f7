"""Writes labels out: one file a shape, and a manifest that says what they are, with hashes."""

import hashlib
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path, PurePosixPath

import numpy as np
from jaxtyping import Int

from partwise import __version__
from partwise.errors import NotFoundError
from partwise.exchange.export_manifest import ExportManifest, ManifestFile, ManifestPart, ManifestShape, write_manifest
from partwise.exchange.ply_labels import LabelledMesh, write_ply_labels
from partwise.exchange.seg import write_seg
from partwise.labels.schema import UNLABELLED as NO_PART
from partwise.labels.schema import PartSchema
from partwise.store.records import Collection
from partwise.workspace.segmentations import Segmentation, SegmentedShape, segmented_shapes
from partwise.workspace.shapes import load_mesh
from partwise.workspace.workspace import Workspace

MANIFEST = "manifest.json"
UNLABELLED = -1
"""What unlabelled faces get in exported files."""


class ExportFormat(StrEnum):
    """seg : a text file of one part id per line, in face order. ply : the mesh with face colours and part ids."""

    SEG = "seg"
    PLY = "ply"


@dataclass(frozen=True, slots=True)
class ExportReport:
    """How many shapes were written, and how many have no such labels."""

    n_written: int
    n_without: int
    manifest: Path


def export_labels(
    workspace: Workspace, collection: Collection, segmentation: Segmentation, file_format: ExportFormat, out: Path
) -> ExportReport:
    """Writes `out/<source key>.<format>` for each shape that has such labels, then the manifest, last.

    Labels are part ids in the order of the file's faces, −1 where unlabelled.

    Raises
    ------
    NotFoundError : no shape has such labels.
    """
    schema = workspace.catalog.parts(collection.id)
    entries = [
        _write(workspace, segmented, schema, file_format, out)
        for segmented in segmented_shapes(workspace, collection, segmentation)
    ]
    if not entries:
        raise NotFoundError(
            f"export needs {segmentation} labels but no shape of {collection.name!r} has any; see `partwise status`"
        )
    parts = tuple(ManifestPart(part.id, part.name, part.colour.lower()) for part in schema.parts)
    manifest = ExportManifest(
        __version__, collection.name, collection.schema_version, parts, segmentation.value, tuple(entries)
    )
    write_manifest(out / MANIFEST, manifest)
    n_shapes = sum(workspace.catalog.state_counts(collection.id).values())
    return ExportReport(len(entries), n_shapes - len(entries), out / MANIFEST)


def _write(
    workspace: Workspace, segmented: SegmentedShape, schema: PartSchema, file_format: ExportFormat, out: Path
) -> ManifestShape:
    shape = segmented.shape
    labels = segmented.labels.astype(np.int64)
    labels[labels == NO_PART] = UNLABELLED
    relative = PurePosixPath(shape.source_key).with_suffix(f".{file_format}")
    path = out / relative
    if file_format is ExportFormat.SEG:
        write_seg(path, labels)
    else:
        colours = {part.id: rgb(part.colour) for part in schema.parts}
        write_ply_labels(path, LabelledMesh(load_mesh(workspace, segmented.mesh), labels), colours)
    return ManifestShape(
        source_key=shape.source_key,
        mesh_hash=segmented.mesh.mesh_hash,
        source_hash=shape.source_hash,
        n_faces=len(labels),
        faces_per_part=_faces_per_part(labels),
        files=(ManifestFile(str(relative), hashlib.sha256(path.read_bytes()).hexdigest()),),
        model_version=segmented.model_version,
    )


def _faces_per_part(labels: Int[np.ndarray, " m"]) -> dict[int, int]:
    part_ids, counts = np.unique(labels, return_counts=True)
    return dict(zip(part_ids.tolist(), counts.tolist(), strict=True))


def rgb(colour: str) -> tuple[int, int, int]:
    """`#E69F00` as (230, 159, 0)."""
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue
