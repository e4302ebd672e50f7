"""A surface is accepted when it is clean and looks like the original."""

import numpy as np

from partwise.features.light_field import light_field
from partwise.mesh import TriMesh
from partwise.remesh.acceptance import judge
from partwise.render.raycast import RayCastRenderer


def test_the_original_itself_is_accepted_at_no_distance(ball: TriMesh, renderer: RayCastRenderer) -> None:
    verdict = judge(ball, light_field(ball, renderer), renderer, 0.0)
    assert (verdict.is_accepted, verdict.distance, verdict.refused) == (True, 0.0, None)


def test_an_open_surface_is_refused_without_a_comparison(
    ball: TriMesh, open_bowl: TriMesh, renderer: RayCastRenderer
) -> None:
    verdict = judge(open_bowl, light_field(ball, renderer), renderer, 1.4)
    assert not verdict.is_accepted
    assert verdict.distance is None
    assert "boundary edges" in str(verdict.refused)


def test_another_shape_is_refused_with_its_distance(ball: TriMesh, renderer: RayCastRenderer) -> None:
    rod = TriMesh(ball.vertices * np.array([1.0, 0.1, 0.1]), ball.faces)
    verdict = judge(rod, light_field(ball, renderer), renderer, 0.2)
    assert verdict.distance is not None
    assert verdict.distance > 0.2
    assert verdict.refused == f"light-field distance {verdict.distance:.3f} where at most 0.200 is accepted"
