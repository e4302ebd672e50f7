"""Predictions are the mean of the snapshots', face by face."""

import numpy as np
import pytest

from partwise.errors import ParameterError
from partwise.learning import ensemble
from partwise.learning.dataset import FacePool
from partwise.learning.ensemble import predict, snapshot_probabilities
from partwise.learning.model import TrainedModel
from partwise.learning.network import NetworkSpec
from partwise.learning.recipe import Recipe
from partwise.learning.trainer import train


@pytest.fixture
def model(pool: FacePool, spec: NetworkSpec, recipe: Recipe) -> TrainedModel:
    return train(pool, spec, recipe)


def test_rows_are_distributions(model: TrainedModel, pool: FacePool) -> None:
    probabilities = predict(model, pool.grids).probabilities
    assert probabilities.shape == (len(pool), 3)
    assert probabilities.dtype == np.float32
    assert probabilities.min() >= 0
    np.testing.assert_allclose(probabilities.sum(axis=1), 1, atol=1e-5)


def test_the_prediction_is_the_mean_of_the_snapshots(model: TrainedModel, pool: FacePool) -> None:
    each = snapshot_probabilities(model, pool.grids)
    assert each.shape == (3, len(pool), 3)
    np.testing.assert_allclose(predict(model, pool.grids).probabilities, each.mean(axis=0), atol=1e-6)


def test_faces_do_not_influence_each_other(
    model: TrainedModel, pool: FacePool, monkeypatch: pytest.MonkeyPatch
) -> None:
    together = predict(model, pool.grids).probabilities
    monkeypatch.setattr(ensemble, "FACES_PER_BATCH", 7)
    np.testing.assert_allclose(predict(model, pool.grids).probabilities, together, atol=1e-5)


def test_no_faces_give_no_rows(model: TrainedModel, pool: FacePool) -> None:
    none = {branch: grids.take(np.arange(0)) for branch, grids in pool.grids.items()}
    assert predict(model, none).probabilities.shape == (0, 3)


def test_a_missing_branch_is_refused(model: TrainedModel, pool: FacePool) -> None:
    with pytest.raises(ParameterError, match="needs spin_image but got shape_context"):
        predict(model, {"shape_context": pool.grids["shape_context"]})
