"""Stage `describe`: shape context, spin image, shape diameter and light-field descriptor of the working mesh."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass

import numpy as np

from partwise.features.describe import Describer
from partwise.features.parameters import DescribeParameters
from partwise.store.array_store import ArrayStore
from partwise.store.block_kinds import FEATURES
from partwise.store.blocks import BlockKind
from partwise.store.quantise import quantise
from partwise_workers.stage import RunStage, ShapeInputs, StageResult
from partwise_workers.stages import remesh

NAME = "describe"


@dataclass(frozen=True, slots=True)
class DescribeStage:
    """The renderer is not part of the identity: both kinds are tested to agree."""

    parameters: DescribeParameters

    @property
    def name(self) -> str:
        return NAME

    @property
    def reads(self) -> str:
        return remesh.NAME

    @property
    def block_kind(self) -> BlockKind:
        return FEATURES

    @property
    def n_steps(self) -> int:
        return 1

    @property
    def identity(self) -> Mapping[str, object]:
        parameters = asdict(self.parameters)
        del parameters["light_field"]["renderer"]
        return {"version": 1, **parameters}

    @contextmanager
    def open(self, arrays: ArrayStore) -> Iterator[RunStage]:  # noqa: ARG002 - the protocol's
        with Describer(self.parameters) as describer:
            yield lambda inputs: _describe(describer, inputs)


def _describe(describer: Describer, inputs: ShapeInputs) -> StageResult:
    mesh = remesh.working_mesh(inputs)
    description = describer.describe(mesh)
    shape_context = quantise(description.shape_context)
    spin_image = quantise(description.spin_image)
    arrays_made = {
        "shape_context": shape_context.codes,
        "shape_context_scale": np.asarray(shape_context.scale),
        "spin_image": spin_image.codes,
        "spin_image_scale": np.asarray(spin_image.scale),
        "shape_diameter": description.shape_diameter,
        "light_field": description.light_field,
    }
    summary = {"core_s": description.core_s, "renderer": describer.renderer, "mesh_hash": mesh.content_hash()}
    return StageResult(arrays_made, summary)
