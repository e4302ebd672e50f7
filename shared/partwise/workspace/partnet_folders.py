"""PartNet's folders as shapes of a collection: ingested as one mesh, labelled by the collection's parts."""

from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path, PurePosixPath

import numpy as np
from jaxtyping import UInt16

from partwise.errors import FileFormatError, LabelError
from partwise.exchange.named_labels import NamedLabels, to_part_ids
from partwise.exchange.partnet import HIERARCHY_FILES, PIECES_FOLDER, read_partnet
from partwise.io.off import format_off
from partwise.labels.schema import PartSchema
from partwise.store.records import Mesh

SUFFIX = ".off"
"""Of the key of a shape that a folder is: `a/42` is `a/42.off`, as which its mesh is kept."""


def is_partnet(folder: Path) -> bool:
    """Whether a folder holds one shape of PartNet."""
    has_hierarchy = any((folder / name).is_file() for name in HIERARCHY_FILES)
    return has_hierarchy and (folder / PIECES_FOLDER).is_dir()


def with_folders(files: Iterator[Path], top: Path) -> Iterator[Path]:
    """The files, in order, with each PartNet folder at or below `top` in place of all files that it holds."""
    is_shape, last = lru_cache(maxsize=64)(is_partnet), None
    for path in files:
        above = [folder for folder in path.parents if folder.is_relative_to(top)]
        home = next((folder for folder in reversed(above) if is_shape(folder)), None)
        if home is None:
            yield path
        elif home != last:
            yield home
        last = home


def folder_key(folder: Path, top: Path) -> str:
    """The source key of the shape that a folder below `top`, or `top` itself, is."""
    inside = folder.relative_to(top).as_posix()
    return f"{folder.name if inside == '.' else inside}{SUFFIX}"


def folder_bytes(folder: Path) -> bytes:
    """The mesh of all pieces, as an OFF file. FileFormatError : it cannot be read as PartNet's; without where it is."""
    try:
        return format_off(read_partnet(folder).mesh)
    except (FileFormatError, LabelError) as error:
        raise FileFormatError(str(error).replace(f"{folder}/", "")) from error


def folder_of(top: Path, source_key: str) -> Path | None:
    """The PartNet folder at or below `top` that a shape was ingested from, None if it is none or not there."""
    stem = PurePosixPath(source_key).with_suffix("")
    if PurePosixPath(source_key).suffix != SUFFIX:
        return None
    return next((folder for folder in (top / stem, top) if folder.name == stem.name and is_partnet(folder)), None)


def folder_labels(folder: Path, mesh: Mesh, schema: PartSchema) -> UInt16[np.ndarray, " m"]:
    """Part ids of the faces of the mesh that was ingested from the folder.

    A face is of the deepest part above its piece that the schema has, by name (`leg`) or path (`chair/base/leg`).

    Raises
    ------
    FileFormatError : it cannot be read as PartNet's.
    LabelError : no part above a piece is in the schema, or the pieces have changed since.
    """
    shape = read_partnet(folder)
    if shape.mesh.n_faces != mesh.n_faces:
        raise LabelError(
            f"{folder}: pieces must be those that were ingested, of {mesh.n_faces:,} faces in all, but have "
            f"{shape.mesh.n_faces:,}; ingest the folder under another name"
        )
    named, known = shape.named_labels(), {part.name: part.id for part in schema.parts}
    used = [named.part_names[index] for index in np.unique(named.indices)]
    parts = {name: _known_part(name, known) for name in used}
    names = tuple(dict.fromkeys(parts.values()))
    index_of = np.array([names.index(parts[name]) if name in parts else 0 for name in named.part_names])
    return to_part_ids(NamedLabels(names, index_of[named.indices]), known, str(folder)).astype(np.uint16)


def _known_part(path: str, known: dict[str, int]) -> str:
    """The name in the schema of the deepest part on a path; the whole path if none is."""
    steps = path.split("/")
    for depth in range(len(steps), 0, -1):
        for name in ("/".join(steps[:depth]), steps[depth - 1]):
            if name in known:
                return name
    return path
