"""Stage `evaluate`: a model's part probabilities for every face, and how unsure it is of the shape."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from partwise.geometry.faces import face_areas
from partwise.learning.dataset import CodedGrids
from partwise.selection.acquisition import mean_entropy, mean_entropy_by_area
from partwise.store.array_store import ArrayStore
from partwise.store.block_kinds import EVALUATION
from partwise.store.blocks import BlockKind
from partwise_workers.model_store import ModelReference, read_model
from partwise_workers.stage import RunStage, ShapeInputs, StageResult
from partwise_workers.stages import describe
from partwise_workers.stages.remesh import working_mesh

if TYPE_CHECKING:
    from partwise.learning.model import TrainedModel

NAME = "evaluate"
ENTROPY = "entropy"
ENTROPY_BY_AREA = "entropy_by_area"
SCORES = (ENTROPY, ENTROPY_BY_AREA)


@dataclass(frozen=True, slots=True)
class EvaluateStage:
    """The summary has the scores, and each predicted part's share of the area."""

    model: ModelReference

    @property
    def name(self) -> str:
        return NAME

    @property
    def reads(self) -> str:
        return describe.NAME

    @property
    def block_kind(self) -> BlockKind:
        return EVALUATION

    @property
    def n_steps(self) -> int:
        return 1

    @property
    def identity(self) -> Mapping[str, object]:
        return {"version": 1, "weights": self.model.weights_key}

    @contextmanager
    def open(self, arrays: ArrayStore) -> Iterator[RunStage]:
        model = read_model(arrays, self.model)
        yield lambda inputs: _evaluate(model, self.model.version, inputs)


def _evaluate(model: "TrainedModel", version: int, inputs: ShapeInputs) -> StageResult:
    from partwise.learning.ensemble import predict  # loads torch, which drivers can do without

    grids = {
        branch: CodedGrids(inputs.array(describe.NAME, branch), inputs.array(describe.NAME, f"{branch}_scale"))
        for branch in model.spec.branches
    }
    probabilities = predict(model, grids, device="cpu").probabilities  # an actor has a core, no card
    mesh = working_mesh(inputs)
    areas = face_areas(mesh)
    predicted = np.argmax(probabilities, axis=1)
    area = np.bincount(predicted, areas, minlength=len(model.part_ids))
    share = area / max(areas.sum(), np.finfo(float).tiny)
    summary = {
        ENTROPY: float(mean_entropy(probabilities)),
        ENTROPY_BY_AREA: float(mean_entropy_by_area(probabilities, areas)),
        "area_share": {str(part): float(s) for part, s in zip(model.part_ids, share, strict=True)},
        "model_version": version,
        "mesh_hash": mesh.content_hash(),
    }
    made = {
        "probabilities": probabilities.astype(np.float16),
        "part_ids": np.array(model.part_ids, dtype=np.uint16),
    }
    return StageResult(made, summary)
