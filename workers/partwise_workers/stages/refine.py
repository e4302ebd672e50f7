"""Stage `refine`: graph cut on the model's probabilities."""

from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass

import numpy as np

from partwise.segmentation.model_refinement import refine
from partwise.segmentation.parameters import RefinementParameters
from partwise.store.array_store import ArrayStore
from partwise.store.block_kinds import REFINEMENT
from partwise.store.blocks import BlockKind
from partwise_workers.stage import RunStage, ShapeInputs, StageResult
from partwise_workers.stages import evaluate
from partwise_workers.stages.remesh import working_mesh

NAME = "refine"


@dataclass(frozen=True, slots=True)
class RefineStage:
    """The summary has the share of faces that the cut changed."""

    parameters: RefinementParameters
    model_version: int

    @property
    def name(self) -> str:
        return NAME

    @property
    def reads(self) -> str:
        return evaluate.NAME

    @property
    def block_kind(self) -> BlockKind:
        return REFINEMENT

    @property
    def n_steps(self) -> int:
        return 1

    @property
    def identity(self) -> Mapping[str, object]:
        return {"version": 1, **asdict(self.parameters)}

    def open(self, arrays: ArrayStore) -> AbstractContextManager[RunStage]:  # noqa: ARG002 - the protocol's
        return nullcontext(self._run)

    def _run(self, inputs: ShapeInputs) -> StageResult:
        probabilities = inputs.array(evaluate.NAME, "probabilities").astype(np.float64)
        part_ids = inputs.array(evaluate.NAME, "part_ids")
        mesh = working_mesh(inputs)
        refined = refine(mesh, probabilities, self.parameters)
        changed = float(np.mean(refined != np.argmax(probabilities, axis=1)))
        summary = {
            "changed_share": changed,
            "model_version": self.model_version,
            "mesh_hash": mesh.content_hash(),
        }
        return StageResult({"labels": part_ids[refined].astype(np.uint16)}, summary)
