"""The images that a shape's thumbnails are coloured from, made once for each mesh by the stage `picture`."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Int32, UInt8

from partwise.errors import NotFoundError
from partwise.store.records import Shape
from partwise.workspace.segmentations import PICTURE
from partwise.workspace.workspace import Workspace


@dataclass(frozen=True, slots=True, eq=False)
class StoredPicture:
    """Images of a mesh that are there, not yet read.

    identity : differs from that of all other pictures. read : (h, w) int32 face ids, −1 for background, and (h, w)
    uint8 shading, see `partwise.render.thumbnail`.
    """

    mesh_hash: str
    identity: str
    read: Callable[[], tuple[Int32[np.ndarray, "h w"], UInt8[np.ndarray, "h w"]]] = field(repr=False)


def find_picture(workspace: Workspace, shape: Shape) -> StoredPicture:
    """The picture of the shape's present mesh.

    Raises
    ------
    NotFoundError : there is none: the shape was not preprocessed since it got this mesh.
    """
    run = workspace.catalog.stage_runs([shape.id], PICTURE).get(shape.id)
    if run is None or run.block_name is None or run.row is None or run.summary["mesh_hash"] != shape.mesh_hash:
        raise NotFoundError(f"shape {shape.id} has no picture of its mesh yet; preprocess the collection")
    block_name, row = run.block_name, run.row

    def read() -> tuple[Int32[np.ndarray, "h w"], UInt8[np.ndarray, "h w"]]:
        images = workspace.arrays.read_many(block_name, row, ("face_ids", "shading"))
        return images["face_ids"], images["shading"]

    return StoredPicture(run.summary["mesh_hash"], f"{PICTURE} {run.id}", read)
