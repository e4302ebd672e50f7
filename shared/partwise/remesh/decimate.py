"""Fewer faces, still a clean manifold: quick quadrics first, reducers that preserve topology where they break it."""

import logging
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import fast_simplification
import igl
import numpy as np
import pymeshlab

from partwise.errors import MeshError
from partwise.geometry.submesh import keep_faces
from partwise.mesh import TriMesh
from partwise.remesh.accept_as_is import defects_of

_log = logging.getLogger(__name__)

Reducer: TypeAlias = Callable[[TriMesh, int], TriMesh]


@dataclass(frozen=True, slots=True, eq=False)
class Decimation:
    """What became of a wish for fewer faces.

    mesh : a clean manifold of about the wanted faces; None where no reducer made one.
    method : the reducer that did, or "none" where the mesh had the faces already; empty where mesh is None.
    failures : why each reducer tried before was not taken, in order.
    """

    mesh: TriMesh | None
    method: str
    failures: tuple[str, ...]


def decimate(mesh: TriMesh, n_faces: int, tolerance: float = 0.05) -> Decimation:
    """A closed manifold in one piece with `n_faces` faces, give or take the tolerance (a share).

    Each reducer's result is examined and the first clean one taken. The mesh itself is returned where it is as small.
    """
    if n_faces < 4:
        return Decimation(None, "", (f"a closed surface has 4 faces or more but {n_faces} were asked for",))
    if mesh.n_faces <= n_faces * (1.0 + tolerance):
        return Decimation(mesh, "none", ())
    failures: list[str] = []
    for name, reduce in _REDUCERS:
        try:
            reduced = reduce(mesh, n_faces)
        except MeshError as error:
            failures.append(f"{name}: {error}")
            continue
        flaw = _flaw(reduced, n_faces, tolerance)
        if flaw is None:
            return Decimation(reduced, name, tuple(failures))
        failures.append(f"{name}: {flaw}")
        _log.debug("reduction refused", extra={"reducer": name, "why": flaw})
    return Decimation(None, "", tuple(failures))


def reduce_quickly(mesh: TriMesh, n_faces: int, aggressiveness: float) -> TriMesh:
    """Quadric edge collapse without a queue (fast-simplification); may break the manifold."""
    vertices, faces = fast_simplification.simplify(
        mesh.vertices.copy(), mesh.faces.copy(), target_count=n_faces, agg=aggressiveness
    )[:2]
    return _used(vertices, faces)


def reduce_keeping_topology(mesh: TriMesh, n_faces: int) -> TriMesh:
    """Quadric edge collapse that refuses collapses which change the topology (pymeshlab); about ten times slower."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=n_faces, preservetopology=True, preservenormal=True)
    reduced = meshes.current_mesh()
    return _used(reduced.vertex_matrix(), reduced.face_matrix())


def reduce_in_order(mesh: TriMesh, n_faces: int) -> TriMesh:
    """Quadric edge collapse in order of cost (libigl's qslim), which keeps manifolds manifold."""
    vertices, faces, *_ = igl.qslim(
        np.asfortranarray(mesh.vertices), np.asfortranarray(mesh.faces.astype(np.int32)), n_faces
    )
    return _used(vertices, faces)


# Each aggressiveness breaks other meshes, so several quick tries come before the slow reducers.
_REDUCERS: tuple[tuple[str, Reducer], ...] = (
    *((f"fast-simplification {a:g}", partial(reduce_quickly, aggressiveness=a)) for a in (4.0, 5.5, 3.0, 7.0)),
    ("pymeshlab", reduce_keeping_topology),
    ("libigl", reduce_in_order),
)


def _flaw(reduced: TriMesh, n_faces: int, tolerance: float) -> str | None:
    if abs(reduced.n_faces - n_faces) > tolerance * n_faces:
        return f"stopped at {reduced.n_faces} faces"
    return defects_of(reduced)


def _used(vertices: np.ndarray, faces: np.ndarray) -> TriMesh:
    mesh = TriMesh(vertices, faces)
    return keep_faces(mesh, np.ones(mesh.n_faces, dtype=bool))
