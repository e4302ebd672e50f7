"""Wraps are clean, enclose everything, and are no finer than is wanted."""

import igl
import numpy as np
import pytest

from partwise.errors import DegenerateMeshError
from partwise.geometry.manifold import manifold_report
from partwise.geometry.surface_points import surface_points
from partwise.mesh import TriMesh
from partwise.remesh.alpha_wrap import alpha_wrap, fitted_wrap
from partwise.remesh.parameters import AlphaWrap

COARSE = AlphaWrap(4.0, 1.0)
POINT = TriMesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))


def outside_share(wrap: TriMesh, mesh: TriMesh) -> float:
    """Share of points on the mesh that the wrap does not enclose."""
    winding = igl.fast_winding_number(wrap.vertices, wrap.faces, surface_points(mesh, 2_000, 50).points)
    return float((np.asarray(winding) < 0.5).mean())


def test_a_sheet_becomes_a_clean_surface_around_it(open_bowl: TriMesh) -> None:
    wrap = alpha_wrap(open_bowl, COARSE)
    assert manifold_report(wrap).is_clean
    assert outside_share(wrap, open_bowl) == 0.0


def test_faces_that_share_an_edge_with_two_others_are_wrapped_too(open_bowl: TriMesh) -> None:
    turned = np.concatenate([open_bowl.faces, open_bowl.faces[:, ::-1], open_bowl.faces])
    fan = TriMesh(
        np.array([[0, 0, -1], [0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 1, 0.0]]),
        np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]]),
    )
    for mesh in (TriMesh(open_bowl.vertices, turned), fan):
        assert outside_share(alpha_wrap(mesh, COARSE), mesh) == 0.0


def test_a_mesh_without_area_cannot_be_wrapped() -> None:
    with pytest.raises(DegenerateMeshError, match="must have area"):
        alpha_wrap(POINT, COARSE)


def test_alpha_is_raised_to_what_the_faces_need(ball: TriMesh) -> None:
    fitted = fitted_wrap(ball, AlphaWrap(0.1, 0.1), 6_000)
    assert fitted.offset_percent == 0.1
    assert alpha_wrap(ball, fitted).n_faces == pytest.approx(6_000, rel=0.4)


def test_alpha_is_never_lowered(ball: TriMesh) -> None:
    assert fitted_wrap(ball, AlphaWrap(1.5, 0.1), 1_000_000) == AlphaWrap(1.5, 0.1)


def test_a_coarse_alpha_is_left_alone(ball: TriMesh) -> None:
    assert fitted_wrap(ball, COARSE, 100) == COARSE
