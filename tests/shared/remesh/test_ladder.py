"""Attempts in order, each recorded; levels reached or absent with a reason."""

import numpy as np
import pytest

from partwise.errors import ConflictError, DegenerateMeshError, ParameterError
from partwise.geometry.manifold import manifold_report
from partwise.mesh import TriMesh
from partwise.remesh.ladder import Ladder, RemeshResult, collect, remesh
from partwise.remesh.parameters import AlphaWrap, ImplicitContour, RemeshParameters
from partwise.render.raycast import RayCastRenderer

QUICK = RemeshParameters(
    wraps=(AlphaWrap(2.5, 0.3),), contours=(ImplicitContour(48),), levels=(2_000, 1_000, 500), max_distance=0.6
)


@pytest.fixture(scope="module")
def two_balls(ball: TriMesh) -> TriMesh:
    """Two balls a diameter apart: no wrap joins them."""
    return TriMesh(
        np.concatenate([ball.vertices, ball.vertices + 4.0]), np.concatenate([ball.faces, ball.faces + ball.n_vertices])
    )


@pytest.fixture(scope="module")
def bowl_result(open_bowl: TriMesh, renderer: RayCastRenderer) -> RemeshResult:
    return remesh(open_bowl, QUICK, renderer)


def test_a_clean_mesh_is_used_as_it_is(ball: TriMesh, renderer: RayCastRenderer) -> None:
    result = remesh(ball, QUICK, renderer)
    assert result.is_as_is
    assert result.working_mesh(500) is ball
    assert [attempt.method for attempt in result.attempts] == ["as is"]


def test_levels_finer_than_a_mesh_are_absent_and_coarser_ones_are_made(
    ball: TriMesh, renderer: RayCastRenderer
) -> None:
    levels = remesh(ball, QUICK, renderer).levels
    assert [level.mesh.n_faces if level.mesh else None for level in levels] == [None, 1_000, 500]
    assert levels[0].absent == "the surface has 1280 faces only"


def test_a_clean_mesh_with_too_many_faces_is_decimated_without_an_attempt(
    ball: TriMesh, renderer: RayCastRenderer
) -> None:
    parameters = RemeshParameters(levels=(1_000, 500), max_faces_as_is=1_000)
    result = remesh(ball, parameters, renderer)
    mesh = result.working_mesh(500)
    assert not result.is_as_is
    assert mesh is not None
    assert (mesh.n_faces, len(result.attempts)) == (500, 1)


def test_an_open_sheet_is_wrapped_and_every_level_is_clean(bowl_result: RemeshResult) -> None:
    meshes = [level.mesh for level in bowl_result.levels if level.mesh is not None]
    assert [attempt.refused is None for attempt in bowl_result.attempts] == [False, True]
    assert meshes
    assert all(manifold_report(mesh).is_clean for mesh in meshes)


def test_an_attempt_records_what_was_done(bowl_result: RemeshResult) -> None:
    as_is, wrap = bowl_result.attempts
    assert "boundary edges" in str(as_is.refused)
    assert (wrap.method, wrap.parameters) == ("alpha wrap", {"alpha_percent": 2.5, "offset_percent": 0.3})
    assert bowl_result.surface is not None
    assert wrap.n_faces == bowl_result.surface.n_faces
    assert wrap.distance is not None
    assert 0.0 < wrap.distance < 0.6


def test_an_attempt_that_looks_different_is_refused_and_the_next_is_made(
    open_bowl: TriMesh, renderer: RayCastRenderer
) -> None:
    parameters = RemeshParameters(
        wraps=(AlphaWrap(40.0, 20.0), AlphaWrap(2.5, 0.3)), contours=(), levels=(500,), max_distance=0.4
    )
    attempts = remesh(open_bowl, parameters, renderer).attempts
    assert "light-field distance" in str(attempts[1].refused)
    assert attempts[2].refused is None


def test_losing_a_piece_is_refused_by_every_attempt(two_balls: TriMesh, renderer: RayCastRenderer) -> None:
    result = remesh(two_balls, QUICK, renderer)
    assert result.surface is None
    assert result.working_mesh(500) is None
    assert result.levels == ()
    assert [attempt.method for attempt in result.attempts] == ["as is", "alpha wrap", "implicit contour"]
    assert all("50.0% of the area" in str(attempt.refused) for attempt in result.attempts[1:])


def test_an_attempt_that_cannot_be_made_is_refused_with_its_reason(renderer: RayCastRenderer) -> None:
    line = TriMesh(np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.0]]), np.array([[0, 1, 2]]))
    result = Ladder(line, QUICK, renderer).attempt(0)
    assert (result.surface, result.attempt.n_faces) == (None, None)
    assert "must have area" in str(result.attempt.refused)


def test_there_is_no_attempt_after_the_last(open_bowl: TriMesh, renderer: RayCastRenderer) -> None:
    ladder = Ladder(open_bowl, QUICK, renderer)
    for index in (-1, 2):
        with pytest.raises(ParameterError, match="attempts are 0 to 1"):
            ladder.attempt(index)


def test_a_level_that_looks_different_is_absent(open_bowl: TriMesh, renderer: RayCastRenderer) -> None:
    surface = Ladder(open_bowl, QUICK, renderer).attempt(0).surface
    assert surface is not None
    strict = RemeshParameters(levels=(100,), max_distance=0.0)
    level = Ladder(open_bowl, strict, renderer).level(surface, 100)
    assert (level.mesh, level.method) == (None, "")
    assert "light-field distance" in str(level.absent)


def test_a_level_that_no_reducer_reaches_is_absent(
    ball: TriMesh, renderer: RayCastRenderer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("partwise.remesh.decimate._REDUCERS", (("a", lambda mesh, n_faces: mesh),))
    assert Ladder(ball, QUICK, renderer).level(ball, 500).absent == "a: stopped at 1280 faces"


def test_a_point_has_no_ladder(renderer: RayCastRenderer) -> None:
    with pytest.raises(DegenerateMeshError):
        Ladder(TriMesh(np.zeros((3, 3)), np.array([[0, 1, 2]])), QUICK, renderer)


def test_only_the_last_step_may_have_a_surface(ball: TriMesh, renderer: RayCastRenderer) -> None:
    accepted = Ladder(ball, QUICK, renderer).as_is()
    for results in ([], [accepted, accepted]):
        with pytest.raises(ConflictError, match="no other, may have a surface"):
            collect(ball, QUICK, results, ())


def test_the_working_mesh_is_the_finest_that_fits(bowl_result: RemeshResult) -> None:
    sizes = [mesh.n_faces for n in (100_000, 1_000, 700, 100) if (mesh := bowl_result.working_mesh(n)) is not None]
    assert bowl_result.surface is not None
    assert sizes == [bowl_result.surface.n_faces, 1_000, 500, 500]
