"""What is kept of several components, and what counts as lost."""

import numpy as np
import pytest

from partwise.mesh import TriMesh
from partwise.remesh.components import largest_outer_component


def scaled(mesh: TriMesh, size: float, shift: float = 0.0, inwards: bool = False) -> TriMesh:
    return TriMesh(mesh.vertices * size + shift, mesh.faces[:, ::-1] if inwards else mesh.faces)


def together(*meshes: TriMesh) -> TriMesh:
    starts = np.cumsum([0, *(mesh.n_vertices for mesh in meshes)])
    return TriMesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]),
    )


def test_one_component_stays_as_it_is(ball: TriMesh) -> None:
    outer = largest_outer_component(ball)
    np.testing.assert_array_equal(outer.mesh.faces, ball.faces)
    assert (outer.dropped_area, outer.n_dropped, outer.n_hidden) == (0.0, 0, 0)


def test_a_cavity_goes_and_counts_for_nothing(ball: TriMesh) -> None:
    outer = largest_outer_component(together(scaled(ball, 0.9, inwards=True), ball))
    assert outer.mesh.n_faces == ball.n_faces
    assert np.linalg.norm(outer.mesh.vertices, axis=1).min() == pytest.approx(1.0)
    assert (outer.dropped_area, outer.n_hidden) == (0.0, 1)


def test_an_enclosed_piece_goes_and_counts_for_nothing(ball: TriMesh) -> None:
    outer = largest_outer_component(together(ball, scaled(ball, 0.8, inwards=True), scaled(ball, 0.3)))
    assert (outer.dropped_area, outer.n_dropped, outer.n_hidden) == (0.0, 0, 2)


def test_a_piece_outside_is_dropped_and_its_area_counts(ball: TriMesh) -> None:
    outer = largest_outer_component(together(scaled(ball, 0.5, shift=3.0), ball))
    assert outer.dropped_area == pytest.approx(0.25 / 1.25)
    assert (outer.n_dropped, outer.n_hidden) == (1, 0)
