"""Writes labels out: one file a shape, and a manifest that says what they are, with hashes."""

import hashlib
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np
from jaxtyping import Int

from partwise import __version__
from partwise.errors import ConflictError, NotFoundError, StoreError
from partwise.exchange.export_manifest import ExportManifest, ManifestFile, ManifestPart, ManifestShape, write_manifest
from partwise.exchange.ply_labels import LabelledMesh, write_ply_labels
from partwise.exchange.seg import write_seg
from partwise.labels.schema import PartSchema
from partwise.store.records import Collection, MeshRole
from partwise.unlabelled import NO_CLASS, NO_PART_ID
from partwise.workspace.choices import ExportFormat as ExportFormat
from partwise.workspace.choices import Segmentation
from partwise.workspace.placed_labels import PlacedLabels, place
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.shapes import load_mesh, pages_of_shapes
from partwise.workspace.workspace import Workspace

MANIFEST = "manifest.json"


@dataclass(frozen=True, slots=True)
class ExportReport:
    """How many shapes were written, and how many have no such labels."""

    n_written: int
    n_without: int
    manifest: Path


def export_labels(
    workspace: Workspace,
    collection: Collection,
    segmentation: Segmentation,
    file_format: ExportFormat,
    out: Path,
    role: MeshRole = MeshRole.WORKING,
    on_progress: OnRunProgress = lambda _: None,
) -> ExportReport:
    """Writes `out/<source key without suffix>.<format>` for each shape that has such labels, and the manifest, last.

    `role` says on which mesh: the working mesh, or the faces of the source file, to which labels are mapped back.

    Where two shapes differ only in their suffix, the later one's file keeps it: `a.obj.seg`. Labels are part ids in the
    order of the file's faces, −1 where unlabelled. Nothing appears in `out` before all files are written.

    Raises
    ------
    NotFoundError : no shape has such labels.
    StoreError : a store cannot be read, or the files cannot be written.
    """
    schema = workspace.catalog.parts(collection.id)
    with _staging_folder(out) as staging:
        entries: list[ManifestShape] = []
        taken: set[str] = set()
        n_shapes, n_seen = sum(workspace.catalog.state_counts(collection.id).values()), 0
        for page in pages_of_shapes(workspace.catalog, collection.id):
            for placed in place(workspace, page, segmentation, role):
                relative = _free_name(placed.shape.source_key, file_format, taken)
                taken.add(relative)
                entries.append(_write(workspace, placed, role, schema, file_format, staging, relative))
                on_progress(RunProgress(n_seen + page.index(placed.shape) + 1, 0, n_shapes))
            n_seen += len(page)
        if not entries:
            raise NotFoundError(
                f"export needs {segmentation} labels but no shape of {collection.name!r} has any; see `partwise status`"
            )
        parts = tuple(
            ManifestPart(part.id, part.name, part.colour.lower(), part.gloss, part.parent_id) for part in schema.parts
        )
        manifest = ExportManifest(
            __version__,
            collection.name,
            schema.version,
            parts,
            segmentation.value,
            tuple(entries),
            parameters={"format": file_format.value, "on": role.value},
        )
        write_manifest(staging / MANIFEST, manifest)
        _move([*sorted(taken), MANIFEST], staging, out)
    return ExportReport(len(entries), n_shapes - len(entries), out / MANIFEST)


def _write(
    workspace: Workspace,
    placed: PlacedLabels,
    role: MeshRole,
    schema: PartSchema,
    file_format: ExportFormat,
    folder: Path,
    relative: str,
) -> ManifestShape:
    shape = placed.shape
    labels = placed.labels.astype(np.int64)
    labels[labels == NO_PART_ID] = NO_CLASS
    path = folder / relative
    if file_format is ExportFormat.SEG:
        write_seg(path, labels)
    else:
        colours = {part.id: rgb(part.colour) for part in schema.parts}
        write_ply_labels(path, LabelledMesh(load_mesh(workspace, placed.mesh), labels), colours)
    return ManifestShape(
        source_key=shape.source_key,
        mesh_hash=placed.mesh.mesh_hash,
        source_hash=shape.source_hash,
        n_faces=len(labels),
        faces_per_part=_faces_per_part(labels),
        files=(ManifestFile(relative, hashlib.sha256(path.read_bytes()).hexdigest()),),
        model_version=placed.model_version,
        kind=placed.kind,
        mesh=role.value,
        revision_ids=placed.revision_ids,
        agreement=placed.agreement,
        is_in_review=placed.is_in_review,
    )


def _free_name(source_key: str, file_format: ExportFormat, taken: set[str]) -> str:
    """Where in the export a shape's file goes: the first of two names that no other shape has."""
    key = PurePosixPath(source_key)
    for name in (str(key.with_suffix(f".{file_format}")), f"{key}.{file_format}"):
        if name not in taken:
            return name
    raise ConflictError(f"each shape's file must have a name of its own but {key} clashes with others; rename it")


@contextmanager
def _staging_folder(out: Path) -> Iterator[Path]:
    """A folder inside `out` that is gone afterwards; so is `out` if it was made for it and nothing came of it."""
    is_new = not out.exists()
    staging = out / f".partial-{secrets.token_hex(6)}"
    try:
        staging.mkdir(parents=True)
    except OSError as error:
        raise StoreError(
            f"{out}: an export needs a folder to write to but: {error.strerror or error}; choose another"
        ) from error
    try:
        yield staging
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        if is_new and not any(out.iterdir()):
            out.rmdir()


def _move(names: list[str], staging: Path, out: Path) -> None:
    """Renames the files into place, in order. An older manifest goes first: it does not vouch for newer files."""
    try:
        (out / MANIFEST).unlink(missing_ok=True)
        for name in names:
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            (staging / name).replace(out / name)
    except OSError as error:
        raise StoreError(
            f"{error.filename}: cannot be written: {error.strerror or error}; export to an empty folder"
        ) from error


def _faces_per_part(labels: Int[np.ndarray, " m"]) -> dict[int, int]:
    part_ids, counts = np.unique(labels, return_counts=True)
    return dict(zip(part_ids.tolist(), counts.tolist(), strict=True))


def rgb(colour: str) -> tuple[int, int, int]:
    """`#E69F00` as (230, 159, 0)."""
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue
