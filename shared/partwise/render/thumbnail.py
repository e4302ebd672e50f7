"""A small picture of a labelled mesh, coloured from two images that were made once.

Needs neither a graphics driver nor a ray caster, so that whoever serves pictures need not install them; the images come
from `partwise.render.face_picture`. Colours change with every new label, what the camera sees does not.
"""

import struct
import zlib
from collections.abc import Mapping

import numpy as np
from jaxtyping import Int32, UInt8, UInt16

from partwise.errors import LabelError, ParameterError
from partwise.render.palette import UNLABELLED_COLOUR

BACKGROUND = -1
"""In an image of face ids: no face is seen."""
PICTURE_SIZE = 384
"""Pixels along each side of the images that are kept."""
SUPERSAMPLING = 2
"""Pixels of the images along each side of a thumbnail's pixel."""
_COMPRESSION = 6
_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_RGBA = 6  # PNG's name of the colour type


def colour_thumbnail(
    face_ids: Int32[np.ndarray, "h w"],
    shading: UInt8[np.ndarray, "h w"],
    labels: UInt16[np.ndarray, " m"],
    colours: Mapping[int, tuple[int, int, int]],
) -> bytes:
    """PNG of the labels on a transparent background, half as high and wide as the images.

    Parameters
    ----------
    face_ids : (h, w) int32, which face a pixel sees, −1 for background. h and w even.
    shading : (h, w) uint8, how bright a white face would be there, sRGB.
    labels : (m,) uint16 part ids. colours : sRGB by part id; parts that are not in it, and unlabelled, are grey.

    Raises
    ------
    ParameterError : images of different, odd or no size. LabelError : a face is seen that has no label.
    """
    _check(face_ids, shading, labels)
    used, part_of_face = np.unique(labels, return_inverse=True)
    table = np.array([colours.get(int(part), UNLABELLED_COLOUR) for part in used], dtype=np.float32)
    is_seen = face_ids != BACKGROUND
    rgb = table[part_of_face[np.where(is_seen, face_ids, 0)]] * (shading[..., None].astype(np.float32) / 255.0)
    n_seen = _boxes(is_seen[..., None].astype(np.float32)).sum(axis=(1, 3))
    mean = _boxes(rgb * is_seen[..., None]).sum(axis=(1, 3)) / np.maximum(n_seen, 1.0)
    alpha = n_seen * (255.0 / SUPERSAMPLING**2)
    return encode_png(np.rint(np.concatenate([mean, alpha], axis=2)).astype(np.uint8))


def encode_png(picture: UInt8[np.ndarray, "h w 4"]) -> bytes:
    """An 8-bit RGBA picture, (h, w, 4) sRGB with straight alpha, as a PNG file.

    Source: ISO/IEC 15948. Differs: each row is filtered by the one above it, which suits smooth pictures.
    """
    height, width, _ = picture.shape
    rows = picture.reshape(height, width * 4)
    up = np.diff(rows, axis=0, prepend=np.zeros((1, width * 4), dtype=np.uint8))
    filtered = np.concatenate([np.full((height, 1), 2, dtype=np.uint8), up], axis=1)  # 2 names the filter "up"
    header = struct.pack(">IIBBBBB", width, height, 8, _RGBA, 0, 0, 0)
    data = zlib.compress(filtered.tobytes(), _COMPRESSION)
    return _SIGNATURE + _chunk(b"IHDR", header) + _chunk(b"IDAT", data) + _chunk(b"IEND", b"")


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def _boxes(values: np.ndarray) -> np.ndarray:
    """(h, w, c) as (h/2, 2, w/2, 2, c): the pixels that make one of the thumbnail's."""
    height, width, n_channels = values.shape
    return values.reshape(height // SUPERSAMPLING, SUPERSAMPLING, width // SUPERSAMPLING, SUPERSAMPLING, n_channels)


def _check(face_ids: np.ndarray, shading: np.ndarray, labels: np.ndarray) -> None:
    size = face_ids.shape
    if (
        size != shading.shape
        or len(size) != 2
        or min(size) < SUPERSAMPLING
        or any(side % SUPERSAMPLING for side in size)
    ):
        raise ParameterError(
            f"images must be of one even size but are {size} and {shading.shape}; are both of the same mesh?"
        )
    if labels.ndim != 1 or int(face_ids.max()) >= len(labels) or int(face_ids.min()) < BACKGROUND:
        raise LabelError(
            f"there must be one label a face but there are {labels.shape} and faces {face_ids.min()} to "
            f"{face_ids.max()} are seen; are both of the same mesh?"
        )
