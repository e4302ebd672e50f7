"""Training learns, keeps what it says it keeps, and repeats itself to the bit."""

import dataclasses

import numpy as np
import pytest
import torch

from partwise.errors import LabelError, ParameterError
from partwise.learning import trainer
from partwise.learning.dataset import CodedGrids, FacePool
from partwise.learning.ensemble import predict
from partwise.learning.model import TrainedModel
from partwise.learning.network import NetworkSpec, PartNetwork
from partwise.learning.recipe import Recipe
from partwise.learning.trainer import train


def _weights(model: TrainedModel) -> bytes:
    return b"".join(array.tobytes() for snapshot in model.snapshots for array in snapshot.values())


def test_the_same_seed_gives_the_same_bits(pool: FacePool, spec: NetworkSpec, recipe: Recipe) -> None:
    assert _weights(train(pool, spec, recipe)) == _weights(train(pool, spec, recipe))


def test_the_number_of_threads_does_not_change_a_bit(pool: FacePool, spec: NetworkSpec, recipe: Recipe) -> None:
    one, three = (_weights(train(pool, spec, recipe, n_threads=n)) for n in (1, 3))
    assert one == three


def test_torchs_global_state_neither_matters_nor_changes(pool: FacePool, spec: NetworkSpec, recipe: Recipe) -> None:
    expected = _weights(train(pool, spec, recipe))
    torch.manual_seed(123)
    state, n_threads = torch.get_rng_state(), torch.get_num_threads()
    assert _weights(train(pool, spec, recipe)) == expected
    assert torch.equal(torch.get_rng_state(), state)
    assert torch.get_num_threads() == n_threads


def test_another_seed_gives_other_weights(pool: FacePool, spec: NetworkSpec, recipe: Recipe) -> None:
    other = dataclasses.replace(recipe, seed=1)
    assert _weights(train(pool, spec, recipe)) != _weights(train(pool, spec, other))


def test_a_separable_problem_is_learned(pool: FacePool, spec: NetworkSpec) -> None:
    model = train(pool, spec, Recipe(n_iterations=60, n_snapshots=2, batch_size=64))
    assert (predict(model, pool.grids).classes == pool.classes).mean() > 0.98


def test_snapshots_differ_and_are_as_many_as_asked(pool: FacePool, spec: NetworkSpec, recipe: Recipe) -> None:
    model = train(pool, spec, recipe)
    assert len({snapshot["output.weight"].tobytes() for snapshot in model.snapshots}) == recipe.n_snapshots


def test_the_first_snapshot_is_taken_at_the_end_of_the_first_cycle(pool: FacePool, spec: NetworkSpec) -> None:
    three_cycles = train(pool, spec, Recipe(n_iterations=12, n_snapshots=3, batch_size=32))
    one_cycle = train(pool, spec, Recipe(n_iterations=4, n_snapshots=1, batch_size=32))
    assert three_cycles.snapshots[0]["output.weight"].tobytes() == one_cycle.snapshots[0]["output.weight"].tobytes()


def test_the_first_step_is_rmsprops(pool: FacePool, spec: NetworkSpec) -> None:
    """From a running mean of 0, the first step is α0 · g / (√(0.1 g²) + 1e-8): α0 · √10 against the gradient's sign."""
    recipe = Recipe(n_iterations=1, n_snapshots=1, batch_size=32)
    weight_seed = np.random.SeedSequence(recipe.seed).spawn(2)[0].generate_state(1)[0]
    initial = PartNetwork(spec, torch.Generator().manual_seed(int(weight_seed))).output.weight.detach().numpy()
    moved = np.abs(train(pool, spec, recipe).snapshots[0]["output.weight"] - initial)
    np.testing.assert_allclose(moved, recipe.learning_rate * np.sqrt(10), rtol=1e-3)


def test_progress_and_history_report_the_mean_loss(pool: FacePool, spec: NetworkSpec) -> None:
    heard: list[tuple[int, float]] = []
    recipe = Recipe(n_iterations=120, n_snapshots=1, batch_size=16)
    model = train(pool, spec, recipe, lambda done, loss: heard.append((done, loss)))
    assert [done for done, _ in heard] == [50, 100, 120]
    assert model.history == tuple(heard)
    assert heard[-1][1] < heard[0][1]


def test_each_feature_is_brought_to_unit_root_mean_square(pool: FacePool, spec: NetworkSpec, recipe: Recipe) -> None:
    model = train(pool, spec, recipe)
    for branch, grids in pool.grids.items():
        inputs = grids.codes * grids.scale[:, None] * model.input_gains[branch]
        assert np.sqrt(np.mean(np.square(inputs))) == pytest.approx(1, rel=1e-4)


def test_a_feature_that_is_zero_everywhere_is_left_alone(spec: NetworkSpec, recipe: Recipe) -> None:
    grids = {name: CodedGrids(np.zeros((9, 256), np.uint8), np.float32(0)) for name in spec.branches}
    model = train(FacePool(grids, np.arange(9) % 3, (1, 2, 3)), spec, recipe)
    assert set(model.input_gains.values()) == {1.0}


def test_a_loss_that_explodes_is_an_error(
    pool: FacePool, spec: NetworkSpec, recipe: Recipe, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(trainer, "learning_rate_at", lambda *_: 1e30)
    with pytest.raises(ParameterError, match="lower the recipe's learning_rate"):
        train(pool, spec, recipe)


def test_another_number_of_parts_is_refused(pool: FacePool, recipe: Recipe) -> None:
    with pytest.raises(LabelError, match="4 classes"):
        train(pool, NetworkSpec(4), recipe)


def test_a_missing_feature_is_refused(pool: FacePool, recipe: Recipe) -> None:
    with pytest.raises(ParameterError, match="needs extras"):
        train(pool, NetworkSpec(3, branches=("spin_image", "extras")), recipe)
