"""Stage `mesh`: reads the ingested file, checks it, and stores it as float32 vertices and uint32 faces."""

from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass

import numpy as np

from partwise.config import MeshConfig
from partwise.errors import MeshError
from partwise.geometry.faces import face_areas
from partwise.geometry.manifold import manifold_report
from partwise.io.read import read_mesh
from partwise.mesh import TriMesh
from partwise.store.array_store import ArrayStore
from partwise.store.block_kinds import MESH
from partwise.store.blocks import BlockKind
from partwise.store.meshes import mesh_arrays
from partwise_workers.stage import RunStage, ShapeInputs, StageResult

NAME = "mesh"
MAX_LOST_SHARE = 0.01
"""Of the faces, that may collapse when coordinates are rounded to float32."""


@dataclass(frozen=True, slots=True)
class MeshStage:
    """Refuses meshes over the face budget. Everything else goes on as it is, with what it is like in the summary."""

    config: MeshConfig

    @property
    def name(self) -> str:
        return NAME

    @property
    def reads(self) -> None:
        return None

    @property
    def block_kind(self) -> BlockKind:
        return MESH

    @property
    def n_steps(self) -> int:
        return 1

    @property
    def identity(self) -> Mapping[str, object]:
        return {"version": 1, **asdict(self.config)}

    def open(self, arrays: ArrayStore) -> AbstractContextManager[RunStage]:  # noqa: ARG002 - the protocol's
        return nullcontext(self._run)

    def _run(self, inputs: ShapeInputs) -> StageResult:
        data, file_name = inputs.source()
        mesh = read_mesh(file_name, data)
        if mesh.n_faces > self.config.max_faces:
            raise MeshError(
                f"a mesh may have at most {self.config.max_faces:,} faces but {file_name} has {mesh.n_faces:,}; "
                "simplify it, or raise max_faces under [mesh] in partwise.toml"
            )
        report = asdict(manifold_report(mesh))
        arrays = mesh_arrays(mesh)
        _check_rounding(arrays["vertices"], report["n_degenerate_faces"], mesh, file_name)
        summary = {
            "mesh_hash": mesh.content_hash(),
            "n_vertices": mesh.n_vertices,
            "n_faces": mesh.n_faces,
            "report": report,
        }
        return StageResult(arrays, summary)


def _check_rounding(stored: np.ndarray, n_degenerate: int, mesh: TriMesh, file_name: str) -> None:
    """Refuses a mesh that loses shape in float32: too large, or small and far from the origin."""
    remedy = "move the shape to the origin, or scale it to a usual size"
    if not np.isfinite(stored).all():
        raise MeshError(f"coordinates must fit float32 but {file_name} has {np.abs(mesh.vertices).max():g}; {remedy}")
    n_lost = int((face_areas(TriMesh(stored, mesh.faces)) <= 0).sum()) - n_degenerate
    if n_lost > MAX_LOST_SHARE * mesh.n_faces:
        raise MeshError(f"faces must keep their area in float32 but {n_lost:,} of {file_name} lose it; {remedy}")


def stored_mesh(inputs: ShapeInputs) -> TriMesh:
    """The mesh that this stage made of the shape in hand."""
    return TriMesh(inputs.array(NAME, "vertices"), inputs.array(NAME, "faces"))
