"""A model survives its files; files that are not a model's are refused."""

import dataclasses
import json
from typing import Any

import numpy as np
import pytest
from safetensors.numpy import load, save

from partwise.errors import FileFormatError, ParameterError
from partwise.learning.dataset import FacePool
from partwise.learning.ensemble import predict
from partwise.learning.model import TrainedModel
from partwise.learning.network import NetworkSpec
from partwise.learning.recipe import Recipe
from partwise.learning.trainer import train
from partwise.learning.weights import ModelFiles, load_model, save_model


@pytest.fixture
def model(pool: FacePool, spec: NetworkSpec, recipe: Recipe) -> TrainedModel:
    return train(pool, spec, recipe)


@pytest.fixture
def files(model: TrainedModel) -> ModelFiles:
    return save_model(model)


def _edited(files: ModelFiles, **changes: Any) -> ModelFiles:
    return ModelFiles(files.weights, json.dumps(json.loads(files.recipe) | changes))


def test_predictions_survive_to_the_bit(model: TrainedModel, files: ModelFiles, pool: FacePool) -> None:
    again = predict(load_model(files), pool.grids).probabilities
    assert again.tobytes() == predict(model, pool.grids).probabilities.tobytes()


def test_everything_but_the_weights_survives(model: TrainedModel, files: ModelFiles) -> None:
    again = load_model(files)
    for name in ("spec", "recipe", "part_ids", "input_gains", "history"):
        assert getattr(again, name) == getattr(model, name)


def test_saving_again_gives_the_same_files(files: ModelFiles) -> None:
    assert save_model(load_model(files)) == files


@pytest.mark.parametrize("keep", [0, 4, 100, -1])
def test_truncated_weights_are_refused(files: ModelFiles, keep: int) -> None:
    with pytest.raises(FileFormatError, match="safetensors"):
        load_model(dataclasses.replace(files, weights=files.weights[:keep]))


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": "other"}'])
def test_other_documents_are_refused(files: ModelFiles, text: str) -> None:
    with pytest.raises(FileFormatError, match="recipe must"):
        load_model(dataclasses.replace(files, recipe=text))


def test_another_version_is_refused(files: ModelFiles) -> None:
    with pytest.raises(FileFormatError, match="is of 2"):
        load_model(_edited(files, version=2))


def test_an_unknown_recipe_key_is_refused(files: ModelFiles) -> None:
    with pytest.raises(FileFormatError, match="momentum"):
        load_model(_edited(files, recipe={"momentum": 1}))


@pytest.mark.parametrize("network", [None, {}, {"n_parts": 3, "widths": 4, "hidden": 16, "branches": ["a"]}])
def test_a_mangled_network_is_refused(files: ModelFiles, network: object) -> None:
    with pytest.raises(FileFormatError, match="edited by hand"):
        load_model(_edited(files, network=network))


def test_another_number_of_part_ids_is_refused(files: ModelFiles) -> None:
    with pytest.raises(FileFormatError, match="as many part ids"):
        load_model(_edited(files, part_ids=[1, 2]))


def test_gains_of_other_branches_are_refused(files: ModelFiles) -> None:
    with pytest.raises(FileFormatError, match="input gains"):
        load_model(_edited(files, input_gains={}))


def test_missing_snapshots_are_refused(files: ModelFiles) -> None:
    tensors = {key: array for key, array in load(files.weights).items() if not key.startswith("2/")}
    with pytest.raises(FileFormatError, match="3 snapshots but there are 2"):
        load_model(dataclasses.replace(files, weights=save(tensors)))


def test_snapshots_with_a_gap_are_refused(files: ModelFiles) -> None:
    tensors = {key: array for key, array in load(files.weights).items() if not key.startswith("1/")}
    with pytest.raises(FileFormatError, match="numbered from 0"):
        load_model(dataclasses.replace(files, weights=save(tensors)))


def test_a_missing_parameter_is_refused(files: ModelFiles) -> None:
    tensors = load(files.weights)
    del tensors["0/output.bias"]
    with pytest.raises(FileFormatError, match=r"differ in output\.bias"):
        load_model(dataclasses.replace(files, weights=save(tensors)))


@pytest.mark.parametrize("bias", [np.zeros(4, np.float32), np.zeros(3, np.float64)])
def test_a_parameter_of_another_form_is_refused(files: ModelFiles, bias: np.ndarray) -> None:
    tensors = load(files.weights) | {"0/output.bias": bias}
    with pytest.raises(FileFormatError, match=r"output\.bias of snapshot 0 must be \(3,\) float32"):
        load_model(dataclasses.replace(files, weights=save(tensors)))


def test_a_weight_that_is_not_finite_is_refused(files: ModelFiles) -> None:
    tensors = load(files.weights) | {"0/output.bias": np.array([0, np.nan, 0], np.float32)}
    with pytest.raises(FileFormatError, match="finite"):
        load_model(dataclasses.replace(files, weights=save(tensors)))


def test_a_model_refuses_what_does_not_fit(model: TrainedModel) -> None:
    with pytest.raises(ParameterError, match="snapshots"):
        dataclasses.replace(model, snapshots=())
