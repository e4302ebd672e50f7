"""Part of a mesh."""

import numpy as np
import pytest

from partwise.errors import MeshError
from partwise.geometry.submesh import keep_faces
from partwise.mesh import TriMesh

TWO = TriMesh(np.arange(18, dtype=np.float64).reshape(6, 3), np.array([[0, 2, 1], [5, 3, 2]]))


def test_kept_faces_have_the_same_corners() -> None:
    part = keep_faces(TWO, np.array([False, True]))
    np.testing.assert_array_equal(part.vertices[part.faces], TWO.vertices[TWO.faces[1:]])


def test_vertices_without_a_face_go() -> None:
    assert keep_faces(TWO, np.array([True, True])).n_vertices == 5


def test_nothing_is_no_mesh() -> None:
    with pytest.raises(MeshError):
        keep_faces(TWO, np.array([False, False]))
