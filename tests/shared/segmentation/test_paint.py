"""What a brush takes: the specification, thin walls, sheets, folds, spines, and what is refused."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import MeshError, ParameterError
from partwise.mesh import TriMesh
from partwise.segmentation.paint import Brush, PaintSurface, painted_faces
from partwise.testing.meshes import meshes
from partwise.testing.plain_paint import plain_painted

_GOLDEN = Path(__file__).parents[2] / "golden" / "paint"
_GOLDEN_FILES = sorted(path.stem for path in _GOLDEN.glob("*.json"))


def _golden(name: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads((_GOLDEN / f"{name}.json").read_text())
    return document


def _golden_surface(name: str) -> PaintSurface:
    document = _golden(name)
    return PaintSurface.build(TriMesh(np.array(document["vertices"]), np.array(document["faces"])))


def _square(shift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) + np.array(shift)
    return corners, np.array([[0, 1, 2], [0, 2, 3]])


@pytest.mark.parametrize("name", _GOLDEN_FILES)
def test_golden_strokes_take_the_recorded_faces(name: str) -> None:
    surface = _golden_surface(name)
    for case in _golden(name)["cases"]:
        is_open = np.ones(surface.n_faces, dtype=bool)
        is_open[case["closed"] or []] = False
        brush = Brush(case["radius"], case["min_cosine"])
        assert painted_faces(surface, case["seeds"], brush, is_open).tolist() == case["faces"], case["seeds"]


def test_golden_strokes_are_there() -> None:
    assert len(_GOLDEN_FILES) == 6


@settings(max_examples=60, deadline=None)
@given(meshes(), st.data())
def test_paint_is_the_specification_in_plain_python(mesh: TriMesh, data: st.DataObject) -> None:
    seeds = data.draw(st.lists(st.integers(0, mesh.n_faces - 1), min_size=1, max_size=3))
    radius = data.draw(st.floats(0.001, 1.0))
    min_cosine = data.draw(st.none() | st.floats(-1.0, 1.0))
    open_faces = data.draw(st.none() | st.sets(st.integers(0, mesh.n_faces - 1)))
    is_open = None if open_faces is None else np.isin(np.arange(mesh.n_faces), sorted(open_faces))
    painted = painted_faces(PaintSurface.build(mesh), seeds, Brush(radius, min_cosine), is_open)
    rounded = mesh.vertices.astype(np.float32).astype(np.float64)
    expected = plain_painted(rounded.tolist(), mesh.faces.tolist(), seeds, radius, min_cosine, open_faces)
    assert painted.tolist() == expected


@settings(max_examples=30, deadline=None)
@given(meshes(), st.data())
def test_a_drag_is_the_union_of_its_clicks(mesh: TriMesh, data: st.DataObject) -> None:
    seeds = data.draw(st.lists(st.integers(0, mesh.n_faces - 1), min_size=1, max_size=4))
    surface, brush = (
        PaintSurface.build(mesh),
        Brush(data.draw(st.floats(0.01, 1.0)), data.draw(st.none() | st.just(0.8))),
    )
    clicks = [painted_faces(surface, [seed], brush) for seed in seeds]
    np.testing.assert_array_equal(painted_faces(surface, seeds, brush), np.unique(np.concatenate(clicks)))


@settings(max_examples=30, deadline=None)
@given(meshes(), st.data())
def test_a_wider_brush_takes_no_less(mesh: TriMesh, data: st.DataObject) -> None:
    seed = data.draw(st.integers(0, mesh.n_faces - 1))
    narrow, wide = sorted(data.draw(st.tuples(st.floats(0.01, 1.0), st.floats(0.01, 1.0))))
    surface = PaintSurface.build(mesh)
    assert set(painted_faces(surface, [seed], Brush(narrow))) <= set(painted_faces(surface, [seed], Brush(wide)))


@settings(max_examples=20, deadline=None)
@given(meshes(), st.integers(0, 2**32 - 1))
def test_face_order_does_not_matter(mesh: TriMesh, seed: int) -> None:
    order = np.random.default_rng(seed).permutation(mesh.n_faces)
    shuffled = TriMesh(mesh.vertices, mesh.faces[order])
    painted = painted_faces(PaintSurface.build(shuffled), [0], Brush(0.4, 0.3))
    expected = painted_faces(PaintSurface.build(mesh), [int(order[0])], Brush(0.4, 0.3))
    np.testing.assert_array_equal(np.sort(order[painted]), expected)


def test_a_thin_wall_hides_its_back() -> None:
    surface = _golden_surface("thin_wall")
    painted = painted_faces(surface, [110], Brush(0.15))
    back = np.arange(200, 400)
    near = np.linalg.norm(surface.centroids[back] - surface.centroids[110], axis=1) < 0.15 * surface.diagonal
    assert near.sum() > 20
    assert not set(back) & set(painted.tolist())


def test_round_the_rim_of_a_thin_wall_paint_reaches_the_back() -> None:
    painted = painted_faces(_golden_surface("thin_wall"), [0], Brush(0.15))
    assert set(range(200, 400)) & set(painted.tolist())


def test_a_sheet_that_is_not_connected_stays_unpainted() -> None:
    painted = painted_faces(_golden_surface("sheets"), [54], Brush(1.0))
    assert painted.tolist() == list(range(128))


def test_vertices_at_one_place_under_two_indices_join_nothing() -> None:
    (left, faces), (right, _) = _square(), _square((1.0, 0.0, 0.0))
    mesh = TriMesh(np.concatenate([left, right]), np.concatenate([faces, faces + 4]))
    assert painted_faces(PaintSurface.build(mesh), [0], Brush(1.0)).tolist() == [0, 1]


def test_an_angle_limit_stops_at_a_sharp_fold() -> None:
    surface = _golden_surface("fold")
    painted = painted_faces(surface, [27], Brush.with_angle(1.0, 60))
    np.testing.assert_array_equal(painted, np.flatnonzero(surface.centroids[:, 2] == 0))
    assert len(painted_faces(surface, [27], Brush(1.0))) == surface.n_faces


def test_the_angle_is_measured_from_the_clicked_face_not_from_face_to_face() -> None:
    surface = _golden_surface("fold")
    painted = painted_faces(surface, [35], Brush.with_angle(1.0, 20))  # the strip bends by 9° a step beyond the fold
    normals = surface.crosses[painted] / surface.cross_lengths[painted, None]
    clicked = surface.crosses[35] / surface.cross_lengths[35]
    assert math.degrees(math.acos((normals @ clicked).min())) == pytest.approx(18, abs=0.01)


def test_all_faces_of_a_spine_touch_each_other() -> None:
    page = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0.5], [0, 1, 0.5], [-1, 0, 0.5]])
    surface = PaintSurface.build(TriMesh(page, np.array([[0, 1, 2], [0, 1, 3], [1, 0, 4]])))
    is_open = np.array([True, False, True])  # a chain by index would be cut at face 1
    assert painted_faces(surface, [0], Brush(1.0), is_open).tolist() == [0, 2]


def test_faces_that_meet_in_a_corner_do_not_touch() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    surface = PaintSurface.build(TriMesh(points, np.array([[0, 1, 2], [0, 3, 4]])))
    assert painted_faces(surface, [0], Brush(1.0)).tolist() == [0]


def test_a_fan_of_many_faces_takes_no_more_room_than_its_faces() -> None:
    n = 20_000  # pairs of neighbours would be 200 million
    angle = np.linspace(0, 6, n)
    rim = np.stack([np.cos(angle), np.sin(angle), np.full(n, 0.5)], axis=1)
    points = np.concatenate([[[0, 0, 0], [0, 0, 1]], rim])
    faces = np.stack([np.zeros(n, int), np.ones(n, int), np.arange(n) + 2], axis=1)
    assert len(painted_faces(PaintSurface.build(TriMesh(points, faces)), [5], Brush(1.0))) == n


def test_a_clicked_face_is_taken_whatever_the_brush() -> None:
    surface = _golden_surface("scraps")
    for seed in range(surface.n_faces):
        assert seed in painted_faces(surface, [seed], Brush(1e-9, 1.0))


def test_a_face_without_area_meets_every_limit_and_sets_none() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0, 0], [0.5, 1, 0], [0.5, -1, 1]])
    flat, up, tilted = [0, 1, 2], [0, 1, 3], [1, 0, 4]
    surface = PaintSurface.build(TriMesh(points, np.array([flat, up, tilted])))
    assert painted_faces(surface, [0], Brush(1.0, 1.0)).tolist() == [0, 1, 2]
    assert painted_faces(surface, [1], Brush(1.0, 0.999)).tolist() == [0, 1]


def test_paint_is_on_the_vertices_that_are_served() -> None:
    corners, faces = _square()
    fine = TriMesh(corners / 3 + 1 / 7, faces)
    served = TriMesh(fine.vertices.astype(np.float32), faces)
    np.testing.assert_array_equal(PaintSurface.build(fine).centroids, PaintSurface.build(served).centroids)


def test_corners_are_added_in_the_specified_order() -> None:
    far = 2.0**60  # one more or less is lost beside it
    mesh = TriMesh(np.array([[1, far, far], [far, 1, -far], [-far, -far, 1]]), np.array([[0, 1, 2]]))
    assert PaintSurface.build(mesh).centroids.tolist() == [[0.0, 0.0, 1 / 3]]


def test_a_vertex_that_no_face_uses_does_not_widen_the_brush() -> None:
    corners, faces = _square()
    mesh = TriMesh(np.concatenate([corners, [[9, 9, 9]]]), faces)
    assert PaintSurface.build(mesh).diagonal == pytest.approx(math.sqrt(2))


def test_coordinates_beyond_float32_are_refused() -> None:
    corners, faces = _square()
    with pytest.raises(MeshError, match="fit float32 but reach 1e"):
        PaintSurface.build(TriMesh(corners * 1e39, faces))


@pytest.mark.parametrize("radius", [0.0, -0.1, 1.01, math.nan, math.inf])
def test_a_radius_out_of_range_is_refused(radius: float) -> None:
    with pytest.raises(ParameterError, match="radius must be in"):
        Brush(radius)


@pytest.mark.parametrize("min_cosine", [-1.01, 1.01, math.nan, math.inf])
def test_a_cosine_out_of_range_is_refused(min_cosine: float) -> None:
    with pytest.raises(ParameterError, match="min_cosine must be in"):
        Brush(0.1, min_cosine)


@pytest.mark.parametrize("degrees", [-1, 181, math.nan])
def test_an_angle_out_of_range_is_refused(degrees: float) -> None:
    with pytest.raises(ParameterError, match="angle limit must be in"):
        Brush.with_angle(0.1, degrees)


@pytest.mark.parametrize("seeds", [[-1], [2], [0, 99]])
def test_a_seed_outside_the_mesh_is_refused(seeds: list[int]) -> None:
    surface = PaintSurface.build(TriMesh(*_square()))
    with pytest.raises(ParameterError, match="a face must be 0 to 1"):
        painted_faces(surface, seeds, Brush(0.1))


def test_no_seeds_are_refused() -> None:
    with pytest.raises(ParameterError, match="at least one seed"):
        painted_faces(PaintSurface.build(TriMesh(*_square())), [], Brush(0.1))


def test_a_mask_of_another_length_is_refused() -> None:
    with pytest.raises(ParameterError, match="one value for each of 2 faces"):
        painted_faces(PaintSurface.build(TriMesh(*_square())), [0], Brush(0.1), np.ones(3, dtype=bool))
