"""Thumbnails: PNG files that Pillow reads, coloured by label, from images that are made once."""

import io
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from partwise.errors import LabelError, ParameterError
from partwise.render.face_picture import face_id_image
from partwise.render.palette import UNLABELLED_COLOUR
from partwise.render.thumbnail import BACKGROUND, colour_thumbnail, encode_png
from partwise.testing.spheres import ball

RED, BLUE = (255, 0, 0), (0, 0, 255)
WHITE = np.full((2, 2), 255, dtype=np.uint8)


def _pixels(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(png)))


def _thumbnail(face_ids, shading, labels, colours) -> np.ndarray:
    images = np.array(face_ids, dtype=np.int32), np.array(shading, dtype=np.uint8)
    return _pixels(colour_thumbnail(*images, np.array(labels, dtype=np.uint16), colours))


def test_a_png_file_holds_the_picture_it_was_made_of() -> None:
    picture = np.random.default_rng(0).integers(0, 256, (5, 7, 4), dtype=np.uint8)
    np.testing.assert_array_equal(_pixels(encode_png(picture)), picture)


def test_a_face_has_the_colour_of_its_label() -> None:
    assert _thumbnail([[0, 0], [0, 0]], WHITE, [2], {1: RED, 2: BLUE}).tolist() == [[[*BLUE, 255]]]


def test_shading_darkens() -> None:
    assert _thumbnail([[0, 0], [0, 0]], WHITE // 5, [1], {1: RED}).tolist() == [[[51, 0, 0, 255]]]


def test_a_pixel_between_two_parts_is_a_mixture() -> None:
    red, _, blue, _ = _thumbnail([[0, 1], [0, 1]], WHITE, [1, 2], {1: RED, 2: BLUE})[0, 0]
    assert (red, blue) == (128, 128)


def test_the_background_is_transparent_and_does_not_darken_the_edge() -> None:
    edge = _thumbnail([[0, BACKGROUND], [BACKGROUND, BACKGROUND]], WHITE, [1], {1: RED})[0, 0]
    assert edge.tolist() == [*RED, 64]
    assert _thumbnail(np.full((2, 2), BACKGROUND), WHITE, [1], {1: RED})[0, 0, 3] == 0


@pytest.mark.parametrize("label", [0, 7])
def test_faces_without_a_known_part_are_grey(label: int) -> None:
    assert _thumbnail([[0, 0], [0, 0]], WHITE, [label], {1: RED})[0, 0, :3].tolist() == list(UNLABELLED_COLOUR)


def test_a_mesh_is_seen_in_the_middle_and_lit() -> None:
    picture = face_id_image(ball(2), size=64)
    assert (picture.face_ids.shape, picture.shading.shape) == ((64, 64), (64, 64))
    assert picture.face_ids[32, 32] >= 0
    assert picture.shading[32, 32] > 0
    assert picture.face_ids[0, 0] == BACKGROUND
    assert picture.shading[0, 0] == 0


def test_the_picture_of_a_mesh_is_coloured_by_its_labels() -> None:
    mesh = ball(1)
    picture = face_id_image(mesh, size=64)
    colours = dict.fromkeys(range(1, mesh.n_faces + 1), RED)
    labels = np.arange(1, mesh.n_faces + 1, dtype=np.uint16)
    pixels = _pixels(colour_thumbnail(picture.face_ids, picture.shading, labels, colours))
    assert pixels.shape == (32, 32, 4)
    assert pixels[..., 1:3].max() == 0
    assert pixels[..., 0].max() > 0


@pytest.mark.parametrize(
    ("face_ids", "shading"),
    [
        (np.zeros((2, 2), np.int32), np.zeros((2, 4), np.uint8)),
        (np.zeros((3, 3), np.int32), np.zeros((3, 3), np.uint8)),
        (np.zeros((0, 2), np.int32), np.zeros((0, 2), np.uint8)),
    ],
)
def test_images_of_different_odd_or_no_size_are_refused(face_ids: np.ndarray, shading: np.ndarray) -> None:
    with pytest.raises(ParameterError, match="of one even size"):
        colour_thumbnail(face_ids, shading, np.ones(1, np.uint16), {})


@pytest.mark.parametrize("face_id", [1, -2])
def test_a_face_without_a_label_is_refused(face_id: int) -> None:
    with pytest.raises(LabelError, match="one label a face"):
        colour_thumbnail(np.full((2, 2), face_id, np.int32), WHITE, np.ones(1, np.uint16), {})


def test_colouring_loads_neither_a_ray_caster_nor_a_picture_library() -> None:
    program = "import sys, partwise.render.thumbnail; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    assert {"embreex", "pyrender", "PIL", "trimesh"}.isdisjoint(loaded)
