"""A recipe is checked when made, and survives JSON."""

import json
from typing import Any

import pytest

from partwise.errors import ParameterError
from partwise.learning.recipe import Recipe, recipe_from_dict, recipe_to_dict


def test_the_defaults_are_those_of_the_paper() -> None:
    assert Recipe() == Recipe("paper", 5000, 5, 0.01, 512, 0.9, 0)


def test_a_recipe_survives_json() -> None:
    recipe = Recipe(n_iterations=40, n_snapshots=4, learning_rate=0.002, batch_size=16, smoothing=0.95, seed=7)
    assert recipe_from_dict(json.loads(json.dumps(recipe_to_dict(recipe)))) == recipe


def test_absent_keys_take_their_defaults() -> None:
    assert recipe_from_dict({"seed": 3}) == Recipe(seed=3)


def test_unknown_keys_are_refused() -> None:
    with pytest.raises(ParameterError, match="momentum"):
        recipe_from_dict({"momentum": 0.5})


def test_draws_are_iterations_times_batch() -> None:
    assert Recipe().n_draws == 2_560_000


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("preset", "papre"),
        ("n_iterations", 0),
        ("n_iterations", 5001),
        ("n_iterations", 5000.0),
        ("n_snapshots", 0),
        ("batch_size", True),
        ("seed", -1),
        ("learning_rate", 0.0),
        ("learning_rate", float("nan")),
        ("learning_rate", 1),
        ("smoothing", 1.0),
    ],
)
def test_values_out_of_range_are_refused(name: str, value: Any) -> None:
    with pytest.raises(ParameterError, match=name):
        Recipe(**{name: value})
