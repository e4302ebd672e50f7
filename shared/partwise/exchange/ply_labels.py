"""PLY with a label and a colour on every face: for viewers, and for reading back."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Int, UInt8

from partwise.errors import FileFormatError, LabelError
from partwise.exchange.label_files import read_label_bytes
from partwise.exchange.labelled_mesh import LabelledMesh as LabelledMesh
from partwise.exchange.parts import Rgb as Rgb
from partwise.io.atomic import write_atomically
from partwise.io.ply import format_ply, parse_ply_face_property
from partwise.io.read import read_mesh
from partwise.unlabelled import NO_CLASS

UNLABELLED_COLOUR: Rgb = (160, 160, 160)
LABEL_PROPERTY = "label"


def read_ply_labels(path: Path | str, data: bytes | None = None) -> LabelledMesh:
    """Mesh and face property `label` of a PLY file.

    Raises
    ------
    FileFormatError : the file is no PLY mesh, or has no whole number `label` per face.
    LabelError : faces are polygons, so that labels do not fit the triangles.
    """
    data = read_label_bytes(path, data)
    mesh = read_mesh(path, data)
    try:
        return LabelledMesh(mesh, parse_ply_face_property(data, LABEL_PROPERTY))
    except (FileFormatError, LabelError) as error:
        raise type(error)(f"{path}: {error}") from error


def write_ply_labels(
    path: Path | str, labelled: LabelledMesh, colours: Mapping[int, Rgb], unlabelled: Rgb = UNLABELLED_COLOUR
) -> None:
    """Writes binary PLY with face properties `red green blue label`.

    Parameters
    ----------
    colours : label → RGB, 0 to 255.
    unlabelled : RGB of faces labelled −1.

    Raises
    ------
    LabelError : a label has no colour, or a colour is not three numbers from 0 to 255.
    StoreError : the file cannot be written.
    """
    face_colours = colour_faces(labelled.labels, colours, unlabelled)
    write_atomically(path, format_ply(labelled.mesh, face_colours, labelled.labels))


def colour_faces(
    labels: Int[np.ndarray, " m"], colours: Mapping[int, Rgb], unlabelled: Rgb = UNLABELLED_COLOUR
) -> UInt8[np.ndarray, "m 3"]:
    """Colour of each face, (m, 3) uint8 RGB. LabelError as `write_ply_labels`."""
    palette = {NO_CLASS: unlabelled, **colours}
    distinct, position = np.unique(labels, return_inverse=True)
    for label in distinct.tolist():
        if label not in palette:
            raise LabelError(f"every label must have a colour but {label} has none; colours are for {sorted(colours)}")
        if len(palette[label]) != 3 or not all(0 <= channel <= 255 for channel in palette[label]):
            raise LabelError(f"a colour must be three numbers from 0 to 255 but {label} has {palette[label]}")
    table = np.array([palette[label] for label in distinct.tolist()], dtype=np.uint8).reshape(-1, 3)
    return table[position.ravel()]
