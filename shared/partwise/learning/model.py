"""`TrainedModel`: what a training makes and a prediction needs, in numpy arrays."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import torch
from jaxtyping import Float32

from partwise.errors import ParameterError
from partwise.learning.network import NetworkSpec, PartNetwork
from partwise.learning.recipe import Recipe

Snapshot: TypeAlias = Mapping[str, Float32[np.ndarray, "..."]]


@dataclass(frozen=True, slots=True, eq=False)
class TrainedModel:
    """An ensemble of snapshots of one network.

    spec : the network's shape.
    recipe : how it was trained.
    part_ids : the part that each class stands for.
    input_gains : branch name to the factor that its sqrt(h) are multiplied by before they enter the network.
    snapshots : `recipe.n_snapshots` dictionaries of parameter name to float32 array.
    history : (iteration, mean loss since the last entry).

    Raises
    ------
    ParameterError : parts, gains, snapshots or the arrays in them do not fit the spec and the recipe.
    """

    spec: NetworkSpec
    recipe: Recipe
    part_ids: tuple[int, ...]
    input_gains: Mapping[str, float]
    snapshots: tuple[Snapshot, ...]
    history: tuple[tuple[int, float], ...]

    def __post_init__(self) -> None:
        if len(self.part_ids) != self.spec.n_parts:
            raise ParameterError(
                f"a model of {self.spec.n_parts} classes needs as many part ids but has {len(self.part_ids)}; retrain"
            )
        if set(self.input_gains) != set(self.spec.branches):
            raise ParameterError(
                f"input gains must be given for {', '.join(self.spec.branches)} but are for "
                f"{', '.join(sorted(self.input_gains)) or 'nothing'}; retrain"
            )
        if len(self.snapshots) != self.recipe.n_snapshots:
            raise ParameterError(
                f"the recipe says {self.recipe.n_snapshots} snapshots but there are {len(self.snapshots)}; "
                "is the file complete?"
            )
        expected = parameter_shapes(self.spec)
        for number, snapshot in enumerate(self.snapshots):
            _require_shapes(number, snapshot, expected)


def parameter_shapes(spec: NetworkSpec) -> dict[str, tuple[int, ...]]:
    """Name and shape of every parameter of a network."""
    with torch.device("meta"):
        network = PartNetwork(spec, generator=None)
    return {name: tuple(parameter.shape) for name, parameter in network.named_parameters()}


def _require_shapes(number: int, snapshot: Snapshot, expected: Mapping[str, tuple[int, ...]]) -> None:
    if snapshot.keys() != expected.keys():
        odd = sorted(snapshot.keys() ^ expected.keys())
        raise ParameterError(
            f"snapshot {number} and the network differ in {', '.join(odd)}; is the file another model's?"
        )
    for name, shape in expected.items():
        array = snapshot[name]
        if array.shape != shape or array.dtype != np.float32:
            raise ParameterError(
                f"{name} of snapshot {number} must be {shape} float32 but is {array.shape} {array.dtype}; "
                "is the file another model's?"
            )
        if not np.isfinite(array).all():
            raise ParameterError(f"{name} of snapshot {number} must be finite but is not; restore or retrain the model")
