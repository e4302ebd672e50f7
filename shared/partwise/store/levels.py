"""A shape's working mesh with its other resolutions, in and out of one row of a `REMESH` block.

`level_sizes` has a row for every level that was asked for: its face count as asked, then how many vertices and faces of
it are in `level_vertices` and `level_faces`, where levels lie one after the other; 0 of an absent level. Also 0 of the
level that `working_level` names by its face count: that is the working mesh, which is not stored twice.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from partwise.errors import NotFoundError
from partwise.mesh import TriMesh
from partwise.store.array_store import ArrayStore
from partwise.store.meshes import mesh_arrays

_NO_LEVEL = 0


def remeshed_arrays(working: TriMesh, levels: Sequence[tuple[int, TriMesh | None]]) -> dict[str, np.ndarray]:
    """The quantities of `block_kinds.REMESH`.

    Parameters
    ----------
    levels : (faces asked for, the mesh or None where it is absent); at least one. The level that is the working mesh is
        known by being the same object.
    """
    stored = [None if mesh is working else mesh for _, mesh in levels]
    parts = [mesh_arrays(mesh) for mesh in stored if mesh is not None]
    sizes = [
        (n, *((0, 0) if m is None else (m.n_vertices, m.n_faces))) for (n, _), m in zip(levels, stored, strict=True)
    ]
    same = [n for n, mesh in levels if mesh is working]
    return {
        **mesh_arrays(working),
        "level_vertices": np.concatenate([np.empty((0, 3), np.float32), *(part["vertices"] for part in parts)]),
        "level_faces": np.concatenate([np.empty((0, 3), np.uint32), *(part["faces"] for part in parts)]),
        "level_sizes": np.array(sizes, dtype=np.uint32),
        "working_level": np.array(same[0] if same else _NO_LEVEL, dtype=np.uint32),
    }


def read_level(arrays: ArrayStore, block_name: str, row: int, n_faces: int) -> TriMesh:
    """The mesh of a level, by the face count that was asked for.

    Raises
    ------
    NotFoundError : the level was not asked for, or is absent.
    StoreError : the store cannot be read.
    """
    index = arrays.read_many(block_name, row, ("level_sizes", "working_level"))
    if n_faces == int(index["working_level"]):
        return _trimesh(arrays.read_many(block_name, row, ("vertices", "faces")))
    sizes = index["level_sizes"].astype(np.int64)
    reached = {int(asked): k for k, (asked, _, held) in enumerate(sizes) if held}
    if n_faces not in reached:
        known = ", ".join(f"{n:,}" for n in sorted({*reached, int(index["working_level"])} - {_NO_LEVEL}, reverse=True))
        raise NotFoundError(
            f"a level must have been reached but {n_faces:,} faces were not; there are: {known or 'none'}"
        )
    found = arrays.read_many(block_name, row, ("level_vertices", "level_faces"))
    before, after = sizes[: reached[n_faces], 1:].sum(axis=0), sizes[: reached[n_faces] + 1, 1:].sum(axis=0)
    own = {name: found[f"level_{name}"][before[k] : after[k]] for k, name in enumerate(("vertices", "faces"))}
    return _trimesh(own)


def _trimesh(values: Mapping[str, np.ndarray]) -> TriMesh:
    return TriMesh(values["vertices"].astype(np.float64), values["faces"].astype(np.int64))
