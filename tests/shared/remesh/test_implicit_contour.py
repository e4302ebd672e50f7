"""The contour lies at its offset, inside and outside."""

import numpy as np
import pytest

from partwise.errors import DegenerateMeshError
from partwise.geometry.manifold import manifold_report
from partwise.mesh import TriMesh
from partwise.remesh.implicit_contour import implicit_contour
from partwise.remesh.parameters import ImplicitContour


def test_a_closed_surface_gets_one_contour_outside_and_one_inside(ball: TriMesh) -> None:
    mesh = implicit_contour(ball, ImplicitContour(32, 1.0))
    radii = np.linalg.norm(mesh.vertices, axis=1)
    offset = 2.0 / 32
    assert manifold_report(mesh).n_components == 2
    np.testing.assert_allclose(np.abs(radii - 1.0), offset, atol=0.2 * offset)


def test_an_open_sheet_gets_one_closed_manifold(open_bowl: TriMesh) -> None:
    assert manifold_report(implicit_contour(open_bowl, ImplicitContour(32, 1.0))).is_clean


def test_more_cells_make_more_faces(open_bowl: TriMesh) -> None:
    counts = [implicit_contour(open_bowl, ImplicitContour(n)).n_faces for n in (16, 32)]
    assert counts[1] > 3 * counts[0]


def test_a_point_cannot_be_contoured() -> None:
    with pytest.raises(DegenerateMeshError, match="must have extent"):
        implicit_contour(TriMesh(np.zeros((3, 3)), np.array([[0, 1, 2]])), ImplicitContour(32))
