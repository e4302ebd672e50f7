"""Which meshes need no remeshing, and what is said of the others."""

import numpy as np
import pytest

from partwise.mesh import TriMesh
from partwise.remesh.accept_as_is import defects_of, signed_volume, why_not_as_is


def test_a_closed_manifold_within_the_budget_is_used_as_it_is(ball: TriMesh) -> None:
    assert why_not_as_is(ball, ball.n_faces) is None


def test_one_face_over_the_budget_is_too_many(ball: TriMesh) -> None:
    assert why_not_as_is(ball, ball.n_faces - 1) == "1280 faces where at most 1279 are used as they are"


def test_volume_of_a_ball(ball: TriMesh) -> None:
    assert signed_volume(ball) == pytest.approx(4.0 / 3.0 * np.pi, rel=0.02)


def test_a_ball_that_looks_inwards_is_not_used(ball: TriMesh) -> None:
    assert defects_of(TriMesh(ball.vertices, ball.faces[:, ::-1])) == "faces look inwards"


def test_a_missing_face_is_named(ball: TriMesh) -> None:
    assert defects_of(TriMesh(ball.vertices, ball.faces[1:])) == "3 boundary edges"


def test_a_second_component_is_named(ball: TriMesh) -> None:
    two = TriMesh(np.concatenate([ball.vertices, ball.vertices + 3]), np.concatenate([ball.faces, ball.faces + 642]))
    assert defects_of(two) == "2 components"


def test_a_turned_face_is_named(ball: TriMesh) -> None:
    faces = ball.faces.copy()
    faces[0] = faces[0, ::-1]
    assert defects_of(TriMesh(ball.vertices, faces)) == "3 misoriented edges"


def test_a_double_face_is_named(ball: TriMesh) -> None:
    double = TriMesh(ball.vertices, np.concatenate([ball.faces, ball.faces[:1]]))
    assert defects_of(double) == "3 non-manifold edges, 1 duplicate faces"


def test_a_face_without_area_is_named(ball: TriMesh) -> None:
    vertices = ball.vertices.copy()
    vertices[ball.faces[0, 0]] = vertices[ball.faces[0, 1]]
    assert defects_of(TriMesh(vertices, ball.faces)) == "2 degenerate faces"


def test_two_tetrahedra_that_touch_in_a_point_are_not_used() -> None:
    one = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    other = np.where(faces == 0, 0, faces + 3)
    touching = TriMesh(np.concatenate([one, -one[1:]]), np.concatenate([faces, other[:, ::-1]]))
    assert defects_of(touching) == "2 components, 1 non-manifold vertices"
