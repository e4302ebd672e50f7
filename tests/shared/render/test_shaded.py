import numpy as np
import pytest
import trimesh

from partwise.errors import DegenerateMeshError, ParameterError
from partwise.mesh import TriMesh
from partwise.render.shaded import Shading, coloured, on_white, shade, shaded_view

WHITE = np.array([255, 255, 255])
AXES = {"x": [1.0, 0, 0], "y": [0.0, 1, 0], "z": [0.0, 0, 1]}


def _sphere() -> TriMesh:
    shape = trimesh.creation.icosphere(subdivisions=4)
    return TriMesh(np.asarray(shape.vertices), np.asarray(shape.faces))


def _flat_colours(mesh: TriMesh, colour: tuple[int, int, int] = (200, 30, 30)) -> np.ndarray:
    return np.tile(np.array(colour, dtype=np.uint8), (mesh.n_faces, 1))


def test_a_sphere_fills_a_round_part_of_the_picture() -> None:
    sphere = _sphere()
    alpha = coloured(shade(sphere, (120, 120)), _flat_colours(sphere))[..., 3] / 255.0
    assert alpha.sum() == pytest.approx(np.pi * (60 / 1.06) ** 2, rel=0.01)
    np.testing.assert_allclose(alpha, alpha[::-1, ::-1], atol=0.35)  # round but for facets at the rim
    assert not alpha[0].any()
    assert not alpha[:, 0].any()


def test_light_comes_from_the_upper_left() -> None:
    light = shade(_sphere(), (100, 100)).light.mean(axis=2)
    assert light[35, 35] > 1.3 * light[65, 65]


def test_the_background_is_white_and_the_hue_is_kept() -> None:
    sphere = _sphere()
    picture = shaded_view(sphere, _flat_colours(sphere), (60, 80))
    assert picture.shape == (60, 80, 3)
    np.testing.assert_array_equal(picture[0, 0], WHITE)
    red, green, blue = picture[30, 40].astype(int)
    assert red > 3 * green
    assert green == blue


def test_a_tall_shape_fits_a_wide_picture() -> None:
    box = trimesh.creation.box(extents=(0.5, 4.0, 0.5))
    is_seen = (shade(TriMesh(np.asarray(box.vertices), np.asarray(box.faces)), (80, 200)).face_ids >= 0).any(axis=2)
    rows = np.flatnonzero(is_seen.any(axis=1))
    assert 1 <= rows[0] <= 4
    assert 75 <= rows[-1] <= 78


@pytest.mark.parametrize("up", ["x", "y", "z", "-x", "-y", "-z"])
def test_what_points_up_is_drawn_above(up: str) -> None:
    sphere = _sphere()
    sign = -1.0 if up.startswith("-") else 1.0
    height = sphere.vertices[sphere.faces].mean(axis=1) @ (sign * np.array(AXES[up[-1]]))
    face_ids = shade(sphere, (60, 60), up=up, supersampling=1).face_ids[..., 0]  # type: ignore[arg-type]
    column = face_ids[:, 30]
    seen = height[column[column >= 0]]
    assert seen[0] > 0.7
    assert seen[-1] < -0.4
    assert (np.diff(seen) < 0.05).all()


def test_upright_frames_do_not_mirror() -> None:
    """With y up and the camera in front, x points right."""
    sphere = _sphere()
    x = sphere.vertices[sphere.faces].mean(axis=1)[:, 0]
    face_ids = shade(sphere, (60, 60), direction=(0, 0, 1), supersampling=1).face_ids[..., 0]
    assert x[face_ids[30, 50]] > 0.5
    assert x[face_ids[30, 10]] < -0.5


def test_winding_does_not_matter_on_flat_faces() -> None:
    triangle = TriMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0.2]]), np.array([[0, 1, 2]]))
    turned = TriMesh(triangle.vertices, triangle.faces[:, ::-1])
    np.testing.assert_allclose(shade(turned, (40, 40)).light, shade(triangle, (40, 40)).light, atol=1e-5)


def test_crowded_surfaces_are_darker() -> None:
    floor = np.array([[-1.0, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]])
    wall = np.array([[-1.0, 0, -1], [1, 0, -1], [1, 1, -1], [-1, 1, -1]])
    quads = np.array([[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]])
    shading = shade(TriMesh(np.concatenate([floor, wall]), quads), (120, 120), direction=(0, 1, 1))
    column = np.where(shading.face_ids < 2, shading.light, np.nan)[:, 60].mean(axis=1)
    on_floor = np.flatnonzero(np.isfinite(column) & (column > 0))
    assert column[on_floor[0] + 1] < 0.85 * column[on_floor[-1] - 5]


def test_colours_are_painted_on_their_faces() -> None:
    face_ids = np.array([[[0, 0], [1, -1]]], dtype=np.int32)
    shading = Shading(face_ids, (face_ids >= 0).astype(np.float32))
    picture = coloured(shading, np.array([[10, 20, 30], [200, 100, 0]], dtype=np.uint8))
    np.testing.assert_array_equal(picture, [[[10, 20, 30, 255], [200, 100, 0, 128]]])


def test_paper_shows_through_what_is_transparent() -> None:
    picture = np.array([[[0, 100, 200, 255], [0, 100, 200, 0], [0, 0, 0, 51]]], dtype=np.uint8)
    np.testing.assert_array_equal(on_white(picture), [[[0, 100, 200], [255, 255, 255], [204, 204, 204]]])


def test_the_same_call_gives_the_same_picture() -> None:
    sphere = _sphere()
    colours = _flat_colours(sphere)
    np.testing.assert_array_equal(shaded_view(sphere, colours, (50, 50)), shaded_view(sphere, colours, (50, 50)))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"size": (0, 10)}, r"size is \(0, 10\)"),
        ({"supersampling": 0}, "1 to 8 but is 0"),
        ({"supersampling": 9}, "1 to 8 but is 9"),
        ({"up": "w"}, "is 'w'"),
        ({"direction": (0.0, 1.0, 0.0)}, "not along up"),
        ({"direction": (0.0, np.nan, 1.0)}, "finite"),
        ({"direction": (1.0, 1.0)}, r"but is \(1\.0, 1\.0\)"),
    ],
)
def test_parameters_out_of_range_are_refused(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        shade(_sphere(), **arguments)  # type: ignore[arg-type]


def test_a_mesh_without_extent_is_refused() -> None:
    with pytest.raises(DegenerateMeshError):
        shade(TriMesh(np.zeros((3, 3)), np.array([[0, 1, 2]])))


def test_colours_of_another_mesh_are_refused() -> None:
    sphere = _sphere()
    with pytest.raises(ParameterError, match="5119 for 5120 faces"):
        shaded_view(sphere, _flat_colours(sphere)[1:])


@pytest.mark.parametrize("colours", [np.zeros((2, 3), dtype=np.uint8), np.zeros((9, 4), dtype=np.uint8)])
def test_a_seen_face_without_a_colour_is_refused(colours: np.ndarray) -> None:
    with pytest.raises(ParameterError, match="one RGB colour a face"):
        coloured(Shading(np.full((1, 1, 1), 2, dtype=np.int32), np.ones((1, 1, 1), dtype=np.float32)), colours)
