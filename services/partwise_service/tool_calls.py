"""What runs in the tools' processes: calls as small picklable values, and `Workbench`, which answers them there.

A call names arrays by their place in the store; a process reads them on first use and keeps the prepared shape, so
that moving a slider sends a few numbers and costs one cut.
"""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import TypeVar, cast

import numpy as np

from partwise.labels.strokes import StrokeLog
from partwise.mesh import TriMesh
from partwise.segmentation.parameters import BoundaryParameters, RefinementParameters
from partwise.segmentation.patch_parameters import PatchMethod
from partwise.store.array_store import ArrayStore
from partwise.store.meshes import read_mesh
from partwise.store.records import Mesh
from partwise.unlabelled import NO_CLASS, NO_PART_ID

Prepared = TypeVar("Prepared")


@dataclass(frozen=True, slots=True)
class StoredRow:
    """Where a shape's arrays are in the store."""

    block_name: str
    row: int


@dataclass(frozen=True, slots=True, eq=False)
class DraftLog:
    """Labels (m,) that a draft's strokes leave, as what it takes to replay them."""

    base_labels: np.ndarray
    log: StrokeLog


GivenLabels = np.ndarray | DraftLog


@dataclass(frozen=True, slots=True)
class PatchesCall:
    """diameters : of the shape, None where it has none on this mesh."""

    mesh: Mesh
    diameters: StoredRow | None
    method: PatchMethod
    n_patches: int


@dataclass(frozen=True, slots=True, eq=False)
class BoundariesCall:
    """labels : (m,) where to start. anchor : (m,) what to stay near; None for the same."""

    mesh: Mesh
    diameters: StoredRow | None
    labels: GivenLabels
    anchor: GivenLabels | None
    parameters: BoundaryParameters


@dataclass(frozen=True, slots=True)
class ModelCall:
    """probabilities : of the shape's faces, as the model left them."""

    mesh: Mesh
    probabilities: StoredRow
    parameters: RefinementParameters


@dataclass(frozen=True, slots=True, eq=False)
class LabelsCall:
    """draft : whose labels are wanted."""

    mesh: Mesh
    draft: DraftLog


ToolCall = PatchesCall | BoundariesCall | ModelCall | LabelsCall


class Workbench:
    """Answers calls, and keeps what depends on the shapes alone of those used last.

    max_prepared : prepared objects, each one tool's on one mesh.
    """

    def __init__(self, arrays: ArrayStore, max_prepared: int) -> None:
        self._arrays = arrays
        self._max_prepared = max_prepared
        self._prepared: OrderedDict[Hashable, object] = OrderedDict()

    def answer(self, call: ToolCall) -> np.ndarray:
        """Patches (m,) uint32, or part ids (m,) uint16. Raises what the tool raises."""
        match call:
            case PatchesCall():
                return self._patches(call)
            case BoundariesCall():
                return self._boundaries(call)
            case ModelCall():
                return self._model(call)
            case LabelsCall():
                return self._replayed(call.mesh, call.draft)

    def _patches(self, call: PatchesCall) -> np.ndarray:
        from partwise.segmentation.patches import over_segment  # its kernels are compiled, which not every use needs

        made = self._kept(
            ("patches", call.method, call.mesh.mesh_hash, call.diameters),
            lambda: over_segment(self._mesh(call.mesh), call.method, self._diameters(call.diameters)),
        )
        return made.patches(call.n_patches).astype(np.uint32)

    def _boundaries(self, call: BoundariesCall) -> np.ndarray:
        from partwise.segmentation.boundary_refinement import BoundaryRefiner

        refiner = self._kept(
            ("boundaries", call.mesh.mesh_hash, call.diameters),
            lambda: BoundaryRefiner.build(self._mesh(call.mesh), self._diameters(call.diameters)),
        )
        labels = self._classes(call.mesh, call.labels)
        anchor = None if call.anchor is None else self._classes(call.mesh, call.anchor)
        return refiner.refine(labels, call.parameters, anchor).astype(np.uint16)

    def _model(self, call: ModelCall) -> np.ndarray:
        from partwise.segmentation.model_refinement import RefinementProblem

        def build() -> tuple[RefinementProblem, np.ndarray]:
            row = call.probabilities
            stored = self._arrays.read_many(row.block_name, row.row, ("probabilities", "part_ids"))
            problem = RefinementProblem.build(self._mesh(call.mesh), stored["probabilities"], call.parameters)
            return problem, stored["part_ids"]

        problem, part_ids = self._kept(("model", call.mesh.mesh_hash, call.probabilities), build)
        return part_ids[problem.solve(call.parameters.smoothness)].astype(np.uint16)

    def _classes(self, mesh: Mesh, given: GivenLabels) -> np.ndarray:
        """(m,) int64 part ids, −1 where unlabelled."""
        labels = self._replayed(mesh, given) if isinstance(given, DraftLog) else given
        return np.where(labels == NO_PART_ID, NO_CLASS, labels.astype(np.int64))

    def _replayed(self, mesh: Mesh, draft: DraftLog) -> np.ndarray:
        from partwise.labels.replay import replayed
        from partwise.segmentation.paint import PaintSurface

        surface = self._kept(("surface", mesh.mesh_hash), lambda: PaintSurface.build(self._mesh(mesh)))
        return replayed(surface, self._mesh(mesh), draft.base_labels, draft.log).labels.copy()

    def _mesh(self, mesh: Mesh) -> TriMesh:
        return self._kept(("mesh", mesh.mesh_hash), lambda: read_mesh(self._arrays, mesh))

    def _diameters(self, where: StoredRow | None) -> np.ndarray | None:
        if where is None:
            return None
        return self._arrays.read(where.block_name, where.row, "shape_diameter").astype(np.float64)

    def _kept(self, key: Hashable, make: Callable[[], Prepared]) -> Prepared:
        if key in self._prepared:
            self._prepared.move_to_end(key)
            return cast(Prepared, self._prepared[key])
        made = make()
        self._prepared[key] = made
        while len(self._prepared) > self._max_prepared:
            self._prepared.popitem(last=False)
        return made
