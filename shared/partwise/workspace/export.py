"""Writes labels out: one file a shape, and a manifest that says what they are, with hashes."""

import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path, PurePosixPath

import numpy as np
from jaxtyping import Int

from partwise import __version__
from partwise.errors import ConflictError, NotFoundError, PartwiseError, StoreError
from partwise.exchange.coco import CocoDataset, CocoShape, write_coco
from partwise.exchange.export_manifest import (
    ExportManifest,
    ManifestFile,
    ManifestShape,
    file_sha256,
    write_manifest,
)
from partwise.exchange.parts import PartTable
from partwise.store.records import Collection, MeshRole
from partwise.workspace.choices import ExportFormat as ExportFormat
from partwise.workspace.choices import PointSampling, Segmentation
from partwise.workspace.export_files import COCO_FILE, ENDINGS, coco_of, file_labels, part_table, write_shape
from partwise.workspace.placed_labels import PlacedLabels, Unplaced, place
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.relabel import require_store
from partwise.workspace.shapes import load_mesh, pages_of_shapes
from partwise.workspace.workspace import Workspace

MANIFEST = "manifest.json"
_DEFAULT_SAMPLING = PointSampling()


@dataclass(frozen=True, slots=True)
class ExportReport:
    """How many shapes were written, and how many have no such labels.

    refused : shapes whose mesh cannot be read, each with why, in one line.
    """

    n_written: int
    n_without: int
    manifest: Path
    refused: tuple[str, ...] = ()


def export_labels(
    workspace: Workspace,
    collection: Collection,
    segmentation: Segmentation,
    file_format: ExportFormat,
    out: Path,
    role: MeshRole = MeshRole.WORKING,
    on_progress: OnRunProgress = lambda _: None,
    sampling: PointSampling = _DEFAULT_SAMPLING,
) -> ExportReport:
    """Writes `out/<source key without suffix>.<ending>` for each shape that has such labels, and the manifest, last.

    COCO is one file for all, `out/coco.json`; ShapeNetPart has `sampling` points a shape, in `.txt` files.

    `role` says on which mesh: the working mesh, or the faces of the source file, to which labels are mapped back.

    Where two shapes differ only in their suffix, the later one's file keeps it: `a.obj.seg`. Labels are part ids in the
    order of the file's faces, −1 where unlabelled. Nothing appears in `out` before all files are written.

    Raises
    ------
    NotFoundError : no shape has such labels.
    StoreError : a store cannot be reached, no shape's mesh can be read, or the files cannot be written.
    """
    schema = workspace.catalog.parts(collection.id)
    parts = part_table(schema)
    with _staging_folder(out) as staging:
        writer = _Writer(workspace, parts, file_format, role, sampling, staging)
        n_shapes = _write_all(writer, collection, segmentation, on_progress)
        if not writer.entries:
            raise _nothing_written(collection, segmentation, writer.refused)
        coco_files = writer.finish()
        manifest = ExportManifest(
            __version__,
            collection.name,
            schema.version,
            parts.parts,
            segmentation.value,
            tuple(writer.entries),
            coco_files,
            {"format": file_format.value, "on": role.value, **_sampling(file_format, sampling)},
        )
        write_manifest(staging / MANIFEST, manifest)
        _move([*sorted(writer.taken), MANIFEST], staging, out)
    n_written, refused = len(writer.entries), tuple(writer.refused)
    return ExportReport(n_written, n_shapes - n_written - len(refused), out / MANIFEST, refused)


@dataclass(slots=True)
class _Writer:
    """Writes shapes into the folder `staging`, or gathers them where all are one file; keeps what to say of them."""

    workspace: Workspace
    parts: PartTable
    file_format: ExportFormat
    role: MeshRole
    sampling: PointSampling
    staging: Path
    entries: list[ManifestShape] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    coco_shapes: list[CocoShape] = field(default_factory=list)
    taken: set[str] = field(default_factory=set)

    def add(self, placed: PlacedLabels | Unplaced) -> None:
        """A shape whose mesh cannot be read is named among `refused` and costs only itself."""
        if isinstance(placed, Unplaced):
            self.refused.append(f"{placed.shape.source_key}: {placed.reason}")
            return
        try:
            files = self._files(placed)
        except (StoreError, NotFoundError) as error:
            if self._is_readable(placed):
                raise
            require_store(self.workspace.arrays)
            self.refused.append(f"{placed.shape.source_key}: {error}")
            return
        self.entries.append(_entry(placed, self.role, files))

    def finish(self) -> tuple[ManifestFile, ...]:
        """Writes the one file of all shapes, if the format has one."""
        if not self.coco_shapes:
            return ()
        write_coco(self.staging / COCO_FILE, CocoDataset(self.parts, tuple(self.coco_shapes)))
        self.taken.add(COCO_FILE)
        return (ManifestFile(COCO_FILE, file_sha256(self.staging / COCO_FILE)),)

    def _files(self, placed: PlacedLabels) -> tuple[ManifestFile, ...]:
        if self.file_format is ExportFormat.COCO:
            self.coco_shapes.append(coco_of(self.workspace, placed, self.parts))
            return ()
        name = _free_name(placed.shape.source_key, ENDINGS[self.file_format], self.taken)
        path = self.staging / name
        write_shape(self.workspace, placed, self.parts, self.file_format, str(path), self.sampling)
        self.taken.add(name)
        return (ManifestFile(name, file_sha256(path)),)

    def _is_readable(self, placed: PlacedLabels) -> bool:
        """Whether it was not the mesh, but the file that could not be written."""
        try:
            load_mesh(self.workspace, placed.mesh)
        except PartwiseError:
            return False
        return True


def _write_all(writer: _Writer, collection: Collection, segmentation: Segmentation, on_progress: OnRunProgress) -> int:
    """Writes every shape that has such labels; returns how many shapes there are."""
    catalog, n_seen = writer.workspace.catalog, 0
    n_shapes = sum(catalog.state_counts(collection.id).values())
    for page in pages_of_shapes(catalog, collection.id):
        for placed in place(writer.workspace, page, segmentation, writer.role):
            writer.add(placed)
            n_refused = len(writer.refused)
            on_progress(RunProgress(n_seen + page.index(placed.shape) + 1 - n_refused, n_refused, n_shapes))
        n_seen += len(page)
    return n_shapes


def _nothing_written(collection: Collection, segmentation: Segmentation, refused: list[str]) -> PartwiseError:
    if refused:
        return StoreError(
            f"export needs meshes that can be read but that of {refused[0]}; so it is with all {len(refused):,} shapes "
            f"of {collection.name!r} that have {segmentation} labels; run `partwise retry --lost`, then preprocess"
        )
    return NotFoundError(
        f"export needs {segmentation} labels but no shape of {collection.name!r} has any; see `partwise status`"
    )


def _sampling(file_format: ExportFormat, sampling: PointSampling) -> dict[str, int]:
    return asdict(sampling) if file_format is ExportFormat.SHAPENETPART else {}


def _entry(placed: PlacedLabels, role: MeshRole, files: tuple[ManifestFile, ...]) -> ManifestShape:
    shape, labels = placed.shape, file_labels(placed)
    return ManifestShape(
        source_key=shape.source_key,
        mesh_hash=placed.mesh.mesh_hash,
        source_hash=shape.source_hash,
        n_faces=len(labels),
        faces_per_part=_faces_per_part(labels),
        files=files,
        model_version=placed.model_version,
        kind=placed.kind,
        mesh=role.value,
        revision_ids=placed.revision_ids,
        agreement=placed.agreement,
        is_in_review=placed.is_in_review,
    )


def _free_name(source_key: str, ending: str, taken: set[str]) -> str:
    """Where in the export a shape's file goes: the first of two names that no other shape has."""
    key = PurePosixPath(source_key)
    for name in (str(key.with_suffix(ending)), f"{key}{ending}"):
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
