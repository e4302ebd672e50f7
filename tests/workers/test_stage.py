"""A stage's key holds all that shapes its result, and is the same on every machine and in every version."""

from dataclasses import replace

import pytest

from partwise.config import MeshConfig
from partwise.features.parameters import DescribeParameters
from partwise.segmentation.parameters import RefinementParameters
from partwise_workers.model_store import ModelReference
from partwise_workers.stage import stage_key
from partwise_workers.stages.describe import DescribeStage
from partwise_workers.stages.evaluate import EvaluateStage
from partwise_workers.stages.mesh import MeshStage
from partwise_workers.stages.refine import RefineStage

SOURCE = "00" * 32


def test_keys_stay_as_they_are() -> None:
    """If one moves, every collection is computed again: bump the stage's version on purpose, then renew it here."""
    mesh = stage_key(MeshStage(MeshConfig(max_faces=1000)), SOURCE)
    assert mesh == "2ae9a94041d79a7cb12f56038d4a9b0c758b421651248d62e4a2e64d39962b34"
    assert (
        stage_key(EvaluateStage(ModelReference("models/a.safetensors", 1)), mesh)
        == "1ad48542bb1de61003ba92c50a4299aafa862e094a2db41112718fb0ef9c8ce5"
    )


def test_the_input_is_part_of_the_key() -> None:
    stage = MeshStage(MeshConfig())
    assert stage_key(stage, SOURCE) != stage_key(stage, "11" * 32)


def test_parameters_are_part_of_the_key() -> None:
    assert stage_key(MeshStage(MeshConfig(1000)), SOURCE) != stage_key(MeshStage(MeshConfig(1001)), SOURCE)


@pytest.mark.parametrize(
    ("descriptor", "change"),
    [("shape_context", {"n_targets": 77}), ("spin_image", {"support": 1.5}), ("shape_diameter", {"alpha": 5.0})],
)
def test_parameters_of_each_descriptor_are_part_of_the_key(descriptor: str, change: dict[str, float]) -> None:
    parameters = DescribeParameters()
    other = replace(parameters, **{descriptor: replace(getattr(parameters, descriptor), **change)})
    assert stage_key(DescribeStage(parameters), SOURCE) != stage_key(DescribeStage(other), SOURCE)


def test_the_renderer_is_not_part_of_the_key() -> None:
    parameters = DescribeParameters()
    other = replace(parameters, light_field=replace(parameters.light_field, renderer="raycast"))
    assert stage_key(DescribeStage(parameters), SOURCE) == stage_key(DescribeStage(other), SOURCE)


def test_the_weights_are_part_of_the_key_and_the_models_number_is_not() -> None:
    keys = [
        stage_key(EvaluateStage(ModelReference(f"models/{weights}.safetensors", version)), SOURCE)
        for weights, version in (("a", 1), ("a", 2), ("b", 1))
    ]
    assert keys[0] == keys[1] != keys[2]


def test_the_smoothness_is_part_of_the_key() -> None:
    keys = {stage_key(RefineStage(RefinementParameters(smoothness=s), 1), SOURCE) for s in (0.1, 0.2)}
    assert len(keys) == 2
