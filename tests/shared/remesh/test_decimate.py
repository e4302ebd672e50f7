"""Fewer faces, always a clean manifold, and every failure is told."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import MeshError
from partwise.geometry.manifold import manifold_report
from partwise.mesh import TriMesh
from partwise.remesh import decimate as module
from partwise.remesh.decimate import decimate, reduce_in_order, reduce_keeping_topology, reduce_quickly

TORUS = trimesh.creation.torus(1.0, 0.3, major_sections=48, minor_sections=24)
MESH = TriMesh(np.asarray(TORUS.vertices), np.asarray(TORUS.faces))


@settings(max_examples=8, deadline=None)
@given(n_faces=st.integers(60, 2_000))
def test_the_result_is_clean_and_as_small_as_wanted(n_faces: int) -> None:
    reduced = decimate(MESH, n_faces, 0.05).mesh
    assert reduced is not None
    assert manifold_report(reduced).is_clean
    assert reduced.n_faces == pytest.approx(n_faces, rel=0.05)


def test_every_reducer_keeps_a_ring_a_ring() -> None:
    for reduced in (reduce_quickly(MESH, 600, 4.0), reduce_keeping_topology(MESH, 600), reduce_in_order(MESH, 600)):
        report = manifold_report(reduced)
        n_edges = reduced.n_faces * 3 // 2
        assert (report.is_clean, reduced.n_vertices - n_edges + reduced.n_faces) == (True, 0)


def test_a_mesh_that_is_small_enough_is_not_touched() -> None:
    result = decimate(MESH, MESH.n_faces + 1)
    assert (result.mesh, result.method) == (MESH, "none")


def test_fewer_faces_than_a_tetrahedron_are_not_reached() -> None:
    result = decimate(MESH, 3)
    assert result.mesh is None
    assert result.failures == ("a closed surface has 4 faces or more but 3 were asked for",)


def test_the_next_reducer_takes_over_where_one_breaks_the_mesh(monkeypatch: pytest.MonkeyPatch) -> None:
    def breaks(mesh: TriMesh, n_faces: int) -> TriMesh:
        return TriMesh(mesh.vertices, mesh.faces[:n_faces])

    def raises(mesh: TriMesh, n_faces: int) -> TriMesh:
        raise MeshError("nothing left")

    def stops(mesh: TriMesh, n_faces: int) -> TriMesh:
        return mesh

    reducers = (("a", breaks), ("b", raises), ("c", stops), ("d", reduce_in_order))
    monkeypatch.setattr(module, "_REDUCERS", reducers)
    result = decimate(MESH, 600)
    assert result.method == "d"
    assert [failure.split(":")[0] for failure in result.failures] == ["a", "b", "c"]
    assert result.failures[1:] == ("b: nothing left", "c: stopped at 2304 faces")


def test_every_reducer_s_failure_is_told_where_all_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_REDUCERS", (("a", lambda mesh, n_faces: mesh),))
    result = decimate(MESH, 600)
    assert (result.mesh, result.failures) == (None, ("a: stopped at 2304 faces",))
